#include "odometry/uncertainty/pose_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "evo/core/median.hpp"
#include "odometry/bundle/normal_equations.hpp"
#include "odometry/bundle/reprojection.hpp"
#include "odometry/uncertainty/rademacher_signs.hpp"

namespace evo::odometry {

namespace {

constexpr std::size_t kRotationSpan = 25;  // poses between which a rotation is compared with the typical one
// Standard deviation over the typical one; less at the start, because the first pose rotates the whole path.
constexpr double kMaxStartRatio = 2.0;
constexpr double kMaxEndRatio = 3.0;
constexpr std::size_t kMaxRemovedFraction = 10;  // at most one in so many poses is removed at either end

/// Errors by the tracks' noise; empty if the system is singular.
std::optional<PoseErrorSamples> SampleTrackErrors(const CovarianceOptions& covariance, const BundleOptions& options,
                                                  const BundleProblem& problem, ThreadPool* pool,
                                                  RademacherSigns* random) {
  const auto begin = FirstObservations(problem);
  const NoiseModel noise{WhiteningSteps(problem, options.drift_variance_ratio), options.cauchy_width_px, true};
  NormalEquations equations(problem, noise, begin, pool);
  equations.Linearize();
  if (!equations.Factorize()) return std::nullopt;
  const auto samples = static_cast<std::size_t>(covariance.samples);
  std::vector<std::vector<double>> signs(samples, std::vector<double>(problem.points.size()));
  for (auto& sample_signs : signs) {
    for (double& sign : sample_signs) sign = random->Next();
  }
  PoseErrorSamples errors(problem.T_cam_world, covariance.samples);
  ForEachIndex(pool, samples, 1, [&](std::size_t k) {
    const Eigen::VectorXd steps = std::sqrt(covariance.variance_inflation) * equations.SolveWithSigns(signs[k]);
    errors.sample(static_cast<Eigen::Index>(k)).tail(steps.size()) = steps;
  });
  return errors;
}

/// Median angle in rad by which the tracks have moved in each frame since the frame before.
std::vector<double> MedianImageMotion(const BundleProblem& problem) {
  std::vector<std::vector<double>> angles(problem.T_cam_world.size());
  for (std::size_t i = 1; i < problem.observations.size(); ++i) {
    const BundleObservation& previous = problem.observations[i - 1];
    const BundleObservation& current = problem.observations[i];
    if (current.point != previous.point || current.frame != previous.frame + 1) continue;
    const Eigen::Vector3d ray = current.x.homogeneous();
    const Eigen::Vector3d previous_ray = previous.x.homogeneous();
    angles[current.frame].push_back(std::atan2(ray.cross(previous_ray).norm(), ray.dot(previous_ray)));
  }
  std::vector<double> motion;
  for (auto& frame_angles : angles) motion.push_back(frame_angles.empty() ? 0.0 : Median(std::move(frame_angles)));
  return motion;
}

/// Adds the rotation by which all tracks err together, a ratio of their motion: the adjustment takes a rotation of the
/// whole image for one of the camera, and the rest of the path rotates with it.
void AddRotationBias(double rotation_bias_ratio, const BundleProblem& problem, RademacherSigns* random,
                     PoseErrorSamples* errors) {
  Eigen::Matrix<double, 3, Eigen::Dynamic> axes(3, errors->samples());
  for (double& axis : axes.reshaped()) axis = rotation_bias_ratio * random->Next();
  const std::vector<double> motion = MedianImageMotion(problem);
  const auto& poses = errors->T_cam_world();
  PoseErrorSamples::Twists rotated = PoseErrorSamples::Twists::Zero(6, errors->samples());
  for (std::size_t i = 1; i < poses.size(); ++i) {
    rotated = (geometry::Adjoint(poses[i] * poses[i - 1].Inverse()) * rotated).eval();
    rotated.bottomRows<3>() += motion[i] * axes;
    errors->twists(i) += rotated;
  }
}

PoseRange FindCertainRange(const PoseErrorSamples& errors) {
  const std::size_t count = errors.poses();
  const std::size_t span = std::min(kRotationSpan, count / 4);
  if (span == 0) return {0, count};
  std::vector<double> sigmas;
  for (std::size_t i = 0; i + span < count; ++i) sigmas.push_back(errors.RotationSigma(i, i + span));
  const double typical = Median(sigmas);
  const auto within = [&](double max_ratio) {
    return [typical, max_ratio](double sigma) { return sigma <= max_ratio * typical; };
  };
  const auto max_removed = static_cast<std::ptrdiff_t>(count / kMaxRemovedFraction);
  const auto at_start =
      std::find_if(sigmas.begin(), sigmas.begin() + max_removed, within(kMaxStartRatio)) - sigmas.begin();
  const auto at_end =
      std::find_if(sigmas.rbegin(), sigmas.rbegin() + max_removed, within(kMaxEndRatio)) - sigmas.rbegin();
  return {static_cast<std::size_t>(at_start), count - static_cast<std::size_t>(at_end)};
}

}  // namespace

std::optional<PoseUncertainty> EstimatePoseUncertainty(const CovarianceOptions& covariance,
                                                       const BundleOptions& options, const BundleProblem& problem,
                                                       ThreadPool* pool) {
  RademacherSigns random(1);
  auto errors = SampleTrackErrors(covariance, options, problem, pool, &random);
  if (!errors) return std::nullopt;
  const PoseRange certain_range = FindCertainRange(*errors);
  AddRotationBias(covariance.rotation_bias_ratio, problem, &random, &*errors);
  return PoseUncertainty{std::move(*errors), certain_range};
}

}  // namespace evo::odometry
