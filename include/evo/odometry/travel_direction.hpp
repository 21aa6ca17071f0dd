#pragma once

#include <Eigen/Core>
#include <vector>

#include "evo/geometry/se3.hpp"

namespace evo {

/// A car rolls where it points and does not slide (non-holonomic constraint): the middle of its rear axle moves along a
/// direction that never changes in the camera's frame. Both are found from the run itself. Ties the camera's turn to
/// the path's, which tracks alone tell apart poorly: a slow turn looks much like a slide.
struct TravelDirection {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< of travel, camera's frame
  double lever = 0.0;  ///< how far the camera is ahead of that point along the direction; the map's units
  double px = 0.0;     ///< what a unit of SideSlip costs, as an error of a sighting; 0: no expectation
};

/// What the motion between two poses has across the direction of travel, as a share of its length (about rad), on two
/// axes across it, and its derivatives by the left twists of the two poses, to second order in the angle between them.
struct SideSlip {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 6> by_before = Eigen::Matrix<double, 2, 6>::Zero();
  Eigen::Matrix<double, 2, 6> by_after = Eigen::Matrix<double, 2, 6>::Zero();
};
Eigen::Vector2d MeasureSideSlip(const TravelDirection& travel, const SE3& before, const SE3& after);
SideSlip LinearizeSideSlip(const TravelDirection& travel, const SE3& before, const SE3& after);

/// The direction, and what side slip costs that is as large as is usual among `poses` (T_cam_world), whose sightings
/// have the noise `sigma_px`.
TravelDirection MeasureTravelDirection(const std::vector<SE3>& poses, double times, double sigma_px);

}  // namespace evo
