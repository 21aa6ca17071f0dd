#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "evo/geometry/se3.hpp"

namespace evo::odometry {

/// Where a point lies beside the path of the camera.
struct PlaceByPath {
  double along = 0.0;     ///< way along the path to where the camera is beside the point
  double below = 0.0;     ///< from there down to the point, at right angles to the path
  double sideways = 0.0;  ///< to the right
  Eigen::Vector3d down;   ///< there, world
};

/// The smoothed way of a camera, by arc length; all lengths in the unit of the poses.
class DrivenPath {
 public:
  /// `positions` and `down` (the camera's y axis) of all poses in order of time, world. Smoothed over `window` to
  /// either side.
  DrivenPath(const std::vector<Eigen::Vector3d>& positions, const std::vector<Eigen::Vector3d>& down, double window);

  double length() const { return nodes_.back().along; }
  /// Arc length of a pose.
  double Along(std::size_t pose) const { return along_[pose]; }
  /// Empty if the camera did not come past the point within `reach` of the pose that saw it.
  std::optional<PlaceByPath> Locate(const Eigen::Vector3d& point, std::size_t pose, double reach) const;

 private:
  struct Node {
    double along = 0.0;
    Eigen::Vector3d position;
    Eigen::Vector3d forward;
    Eigen::Vector3d down;
  };

  void AddNodes(const std::vector<Eigen::Vector3d>& positions, const std::vector<Eigen::Vector3d>& down,
                double spacing);
  void Smooth(double window);

  std::vector<Node> nodes_;
  std::vector<std::size_t> node_of_;  // of each pose, the last before it
  std::vector<double> along_;         // of each pose
};

}  // namespace evo::odometry
