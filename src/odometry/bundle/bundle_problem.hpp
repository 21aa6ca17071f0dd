#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "odometry/bundle/motion_prior.hpp"

namespace evo::odometry {

/// A point as (alpha, beta, rho) in the camera of its anchor frame: p_anchor = (alpha, beta, 1) / rho (A. I. Mourikis,
/// S. I. Roumeliotis: A Multi-State Constraint Kalman Filter for Vision-aided Inertial Navigation, ICRA 2007).
/// rho = 0 is a point at infinity; far points are as well conditioned as near ones.
struct BundlePoint {
  int anchor = 0;                 ///< index of the pose
  Eigen::Vector3d inverse_depth;  ///< alpha, beta, rho
  double weight = 1.0;            ///< of its errors: typical standard deviation over this track's own
};

struct BundleObservation {
  int frame = 0;                       ///< index of the pose
  int point = 0;                       ///< index of the point
  Eigen::Vector2d x;                   ///< undistorted, on the plane z = 1
  Eigen::Matrix2d J_pixel_normalized;  ///< raw pixels by x, see Feature
};

struct BundleProblem {
  std::vector<geometry::SE3> T_cam_world;  ///< in order of time
  int fixed_frames = 1;  ///< number of poses at the start that stay fixed: 1 leaves the scale free, 2 fix it
  int scale_frame = -1;  ///< the pose whose distance from the first one is held and so fixes the scale; -1: none
  MotionPrior motion;
  std::vector<BundlePoint> points;
  std::vector<BundleObservation> observations;  ///< in order of points, then of frames
};

/// Position of a point in the world; infinite for rho = 0.
Eigen::Vector3d WorldPosition(const BundleProblem& problem, const BundlePoint& point);

/// Index of every point's first observation; the number of all observations at the end.
std::vector<std::size_t> FirstObservations(const BundleProblem& problem);

/// First block column of every row of the reduced system: for every free pose the first free pose that shares a point
/// or a change of velocity with it.
std::vector<int> ReducedSystemSkyline(const BundleProblem& problem);

}  // namespace evo::odometry
