#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

namespace evo::evaluation {

/// Finds, among positions in order of time, the next one that is far away. Boxes and spheres around runs of positions
/// let a long stay in one place be passed over in O(log n) where a walk would take O(n) from each of its poses.
class PositionSearch {
 public:
  /// At least one position.
  explicit PositionSearch(std::vector<Eigen::Vector3d> positions);

  /// Index of the first position at or after `from` that is `distance` or more from `center`.
  std::optional<std::size_t> FirstFar(std::size_t from, const Eigen::Vector3d& center, double distance) const;
  /// Index of the last such position at or before `from`.
  std::optional<std::size_t> LastFar(std::size_t from, const Eigen::Vector3d& center, double distance) const;

  const std::vector<Eigen::Vector3d>& positions() const { return positions_; }

 private:
  struct Run {
    Eigen::AlignedBox3d box;
    double radius = 0.0;  // of a sphere around the middle of the box
  };

  bool MayBeFar(std::size_t level, std::size_t node, const Eigen::Vector3d& center, double distance) const;

  std::vector<Eigen::Vector3d> positions_;
  /// Runs of level 0 hold one position each, those of every further one two runs of the level below.
  std::vector<std::vector<Run>> levels_;
};

}  // namespace evo::evaluation
