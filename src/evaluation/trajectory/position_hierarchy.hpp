#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

namespace evo::evaluation {

/// A bounding volume hierarchy over positions in order of time. It finds the next position outside a ball in O(log n)
/// during a long stop, where a linear search takes O(n) from each pose.
class PositionHierarchy {
 public:
  /// At least one position.
  explicit PositionHierarchy(std::vector<Eigen::Vector3d> positions);

  /// Index of the first position at or after `from` that is at least `radius` from `center`.
  std::optional<std::size_t> FirstOutside(std::size_t from, const Eigen::Vector3d& center, double radius) const;
  /// Index of the last such position at or before `from`.
  std::optional<std::size_t> LastOutside(std::size_t from, const Eigen::Vector3d& center, double radius) const;

  const std::vector<Eigen::Vector3d>& positions() const { return positions_; }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    double radius = 0.0;  // of a sphere around the centre of the box
  };

  bool MayLeave(std::size_t level, std::size_t node, const Eigen::Vector3d& center, double radius) const;

  std::vector<Eigen::Vector3d> positions_;
  /// A node of level 0 holds one position, one of any other level two nodes of the level below.
  std::vector<std::vector<Node>> levels_;
};

}  // namespace evo::evaluation
