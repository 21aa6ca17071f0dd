#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace evo::odometry {

/// A point in the frame that moves along the path, at the place where the path passes it. Lengths in the poses' unit.
struct PathCoordinates {
  double arc_length = 0.0;  ///< of that place
  double below = 0.0;       ///< from there down to the point, at right angles to the path
  double right = 0.0;       ///< from there to the right
  Eigen::Vector3d down;     ///< the frame's axis down, world
};

/// The smoothed path of a camera by arc length with a frame at every place: forward along the tangent, down as the
/// camera's y axis, right. Like a Frenet frame, but its normal is the camera's and not the curvature's, so that it is
/// defined on a straight path.
class PathFrame {
 public:
  /// `positions` and `down` (the camera's y axis) of all poses in order of time, world; smoothed over an arc length of
  /// `window` to either side.
  PathFrame(const std::vector<Eigen::Vector3d>& positions, const std::vector<Eigen::Vector3d>& down, double window);

  double length() const { return nodes_.back().arc_length; }
  double arc_length(std::size_t pose) const { return arc_lengths_[pose]; }
  /// The coordinates of a point that `pose` has observed; empty if the path does not pass it within an arc length of
  /// `max_distance` from there.
  std::optional<PathCoordinates> Locate(const Eigen::Vector3d& point, std::size_t pose, double max_distance) const;

 private:
  struct Node {
    double arc_length = 0.0;
    Eigen::Vector3d position;
    Eigen::Vector3d forward;
    Eigen::Vector3d down;
  };

  void AddNodes(const std::vector<Eigen::Vector3d>& positions, const std::vector<Eigen::Vector3d>& down,
                double spacing);
  void Smooth(double window);

  std::vector<Node> nodes_;
  std::vector<std::size_t> last_nodes_;  // at or before each pose
  std::vector<double> arc_lengths_;      // of each pose
};

}  // namespace evo::odometry
