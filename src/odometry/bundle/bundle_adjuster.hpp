#pragma once

#include <Eigen/Core>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/geometry/se3.hpp"
#include "odometry/bundle/motion_prior.hpp"

namespace evo::odometry {

/// A point as (alpha, beta, rho) in the camera of its anchor frame: X_anchor = (alpha, beta, 1) / rho.
/// Inverse depth makes far points as harmless as near ones; rho = 0 is a point at infinity.
struct BundlePoint {
  int anchor = 0;                 ///< frame
  Eigen::Vector3d inverse_depth;  ///< alpha, beta, rho
  double weight = 1.0;            ///< of its sightings' errors: their usual noise over this track's own
};

struct BundleObservation {
  int frame = 0;
  int point = 0;
  Eigen::Vector2d x;                   ///< on the plane z = 1
  Eigen::Matrix2d J_pixel_normalized;  ///< see Feature
};

struct BundleProblem {
  std::vector<geometry::SE3> T_cam_world;  ///< in order of time
  int fixed_frames = 1;                    ///< the first so many poses stay: 1 leaves the scale free, 2 holds it
  int scale_frame = -1;  ///< a frame whose distance from the first is held, to hold the scale; -1: none
  MotionPrior motion;
  std::vector<BundlePoint> points;
  std::vector<BundleObservation> observations;  ///< in order of points, then of frames
};

struct BundleOptions {
  int iterations = 20;
  double loss_px = 1.0;             ///< Cauchy's width
  double drift = 0.0;               ///< of tracks, from sighting to sighting, see InnovationStep
  double relative_decrease = 1e-8;  ///< of the cost in one step: stop below
};

struct BundleSummary {
  int iterations = 0;
  double initial_cost = 0.0;  ///< px^2
  double final_cost = 0.0;    ///< px^2
};

/// The residual in raw pixels (to first order about the observation) and its derivatives by the left twist of the
/// camera and by the point's three numbers, the anchor held. False if the point is behind the camera.
struct BundleJacobian {
  Eigen::Vector2d error = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 6> by_pose = Eigen::Matrix<double, 2, 6>::Zero();
  Eigen::Matrix<double, 2, 3> by_point = Eigen::Matrix<double, 2, 3>::Zero();
};
bool Linearize(const geometry::SE3& T_cam_anchor, const Eigen::Vector3d& inverse_depth,
               const BundleObservation& observation, BundleJacobian* jacobian);

/// Refines poses and points together: Levenberg-Marquardt on Cauchy's loss of the innovations of the reprojection
/// errors and of the changes of velocity, the points eliminated by Schur's complement, the poses solved by a skyline
/// Cholesky factorisation. The result does not depend on the number of threads of `pool`; without one this thread does
/// it all.
BundleSummary AdjustBundle(const BundleOptions& options, BundleProblem* problem, ThreadPool* pool = nullptr);

/// Where a point of the problem is in the world; infinite for rho = 0.
Eigen::Vector3d WorldPosition(const BundleProblem& problem, const BundlePoint& point);

/// The residual of every observation in px, infinite behind the camera.
std::vector<Eigen::Vector2d> BundleErrors(const BundleProblem& problem);

/// The same as innovations for that drift, see InnovationStep, times the weights of their points.
std::vector<Eigen::Vector2d> BundleInnovations(const BundleProblem& problem, double drift);

/// The part of every residual that is thought to be drift, see EstimateDrift.
std::vector<Eigen::Vector2d> BundleDrifts(const BundleProblem& problem, double drift);

/// For every pose that is free, the first free pose that shares a point or a change of velocity with it: the skyline of
/// the reduced system.
std::vector<int> BundleSkyline(const BundleProblem& problem);

}  // namespace evo::odometry
