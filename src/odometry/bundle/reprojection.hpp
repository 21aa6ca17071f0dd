#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "odometry/bundle/bundle_problem.hpp"
#include "odometry/bundle/whitening_filter.hpp"

namespace evo::odometry {

/// A reprojection error in raw pixels (observed minus projected, to first order about the observation) and its
/// Jacobians by the left twist of T_cam_anchor and by the point's inverse depth.
struct LinearizedReprojection {
  Eigen::Vector2d error = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 6> J_error_pose = Eigen::Matrix<double, 2, 6>::Zero();
  Eigen::Matrix<double, 2, 3> J_error_point = Eigen::Matrix<double, 2, 3>::Zero();
};
/// False if the point is behind the camera.
bool LinearizeReprojection(const geometry::SE3& T_cam_anchor, const Eigen::Vector3d& inverse_depth,
                           const BundleObservation& observation, LinearizedReprojection* linearized);

/// Errors of the observations [begin, end) of one point in px, infinite behind the camera.
void ComputeTrackErrors(const BundleProblem& problem, std::size_t begin, std::size_t end,
                        std::vector<Eigen::Vector2d>* errors);

/// Errors of all observations in px, infinite behind the camera.
std::vector<Eigen::Vector2d> ReprojectionErrors(const BundleProblem& problem);

/// The whitening filter's steps at all observations, with the magnifications of the problem's present values and times
/// the points' weights.
std::vector<WhiteningStep> WhiteningSteps(const BundleProblem& problem, double drift_variance_ratio);

/// Normalised innovations of all observations' errors in px, times the points' weights, see WhiteningStep.
std::vector<Eigen::Vector2d> ReprojectionInnovations(const BundleProblem& problem, double drift_variance_ratio);

/// The estimated drift in every observation's error in px, see EstimateDrift.
std::vector<Eigen::Vector2d> ReprojectionDrifts(const BundleProblem& problem, double drift_variance_ratio);

}  // namespace evo::odometry
