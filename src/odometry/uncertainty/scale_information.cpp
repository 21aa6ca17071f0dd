#include "odometry/uncertainty/scale_information.hpp"

#include <cmath>
#include <utility>

#include "odometry/uncertainty/rademacher_signs.hpp"

namespace evo::odometry {

namespace {

/// The steps from pose to pose; those to the first are zero.
struct PathSteps {
  explicit PathSteps(const std::vector<geometry::SE3>& T_cam_world)
      : steps(T_cam_world.size(), Eigen::Vector3d::Zero()), lengths(T_cam_world.size()), arc_lengths(lengths) {
    const auto centres = CameraCentres(T_cam_world);
    for (std::size_t i = 1; i < centres.size(); ++i) {
      steps[i] = centres[i] - centres[i - 1];
      lengths[i] = steps[i].norm();
      arc_lengths[i] = arc_lengths[i - 1] + lengths[i];
    }
  }

  std::vector<Eigen::Vector3d> steps;
  std::vector<double> lengths;
  std::vector<double> arc_lengths;  // from the first pose
};

/// Errors of the steps in one sample, in the new scale.
std::vector<Eigen::Vector3d> StepErrors(const PoseErrorSamples& errors, Eigen::Index sample, const PathSteps& old_path,
                                        const PathSteps& path) {
  std::vector<Eigen::Vector3d> step_errors(errors.poses(), Eigen::Vector3d::Zero());
  for (std::size_t i = 1; i < step_errors.size(); ++i) {
    const double scale = old_path.lengths[i] > 0.0 ? path.lengths[i] / old_path.lengths[i] : 1.0;
    step_errors[i] = scale * (errors.CentreError(i, sample) - errors.CentreError(i - 1, sample));
  }
  return step_errors;
}

/// The scale's relative error at every pose by the tracks: the mean along the path over `window` around the pose.
std::vector<double> TrackScaleErrors(const std::vector<Eigen::Vector3d>& step_errors, const PathSteps& path,
                                     double window) {
  const std::size_t count = step_errors.size();
  std::vector<double> excess_lengths(count);  // of the path up to each pose
  for (std::size_t i = 1; i < count; ++i) {
    const double excess = path.lengths[i] > 0.0 ? step_errors[i].dot(path.steps[i]) / path.lengths[i] : 0.0;
    excess_lengths[i] = excess_lengths[i - 1] + excess;
  }
  std::vector<double> scale_errors(count);
  std::size_t from = 0, to = 0;
  for (std::size_t i = 0; i < count; ++i) {
    while (path.arc_lengths[i] - path.arc_lengths[from] > 0.5 * window) ++from;
    while (to + 1 < count && path.arc_lengths[to] - path.arc_lengths[i] < 0.5 * window) ++to;
    const double length = path.arc_lengths[to] - path.arc_lengths[from];
    scale_errors[i] = length > 0.0 ? (excess_lengths[to] - excess_lengths[from]) / length : 0.0;
  }
  return scale_errors;
}

}  // namespace

double EstimateScaleDrift(const PoseErrorSamples& errors, double window) {
  const PathSteps path(errors.T_cam_world());
  double sum = 0.0;
  std::size_t count = 0;
  for (Eigen::Index k = 0; k < errors.samples(); ++k) {
    const auto scale_errors = TrackScaleErrors(StepErrors(errors, k, path, path), path, window);
    std::size_t to = 0;
    for (std::size_t i = 0; i < errors.poses(); ++i) {
      while (to < errors.poses() && path.arc_lengths[to] - path.arc_lengths[i] < window) ++to;
      if (to == errors.poses()) break;
      sum += std::pow(scale_errors[to] - scale_errors[i], 2);
      ++count;
    }
  }
  // Means of a random walk over adjoining windows differ by 2/3 of its variance over a window.
  return count > 0 ? std::sqrt(1.5 * sum / (static_cast<double>(count) * window)) : 0.0;
}

void ApplyScaleInformation(const ScaleInformation& information, std::vector<geometry::SE3> T_cam_world,
                           PoseErrorSamples* errors) {
  const double correlation_length = information.correlation_length;
  const PathSteps old_path(errors->T_cam_world());
  const PathSteps path(T_cam_world);
  PoseErrorSamples rescaled = *errors;
  rescaled.SetPoses(std::move(T_cam_world));
  RademacherSigns random(2);
  for (Eigen::Index k = 0; k < errors->samples(); ++k) {
    const auto step_errors = StepErrors(*errors, k, old_path, path);
    const auto track_scale_errors = TrackScaleErrors(step_errors, path, correlation_length);
    double scale_error = information.relative_sigma * random.Next();
    Eigen::Vector3d centre_error = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < errors->poses(); ++i) {
      const double correlation = correlation_length > 0.0 ? std::exp(-path.lengths[i] / correlation_length) : 0.0;
      scale_error = correlation * scale_error +
                    std::sqrt(1.0 - correlation * correlation) * information.relative_sigma * random.Next();
      if (i > 0) centre_error += step_errors[i] + (scale_error - track_scale_errors[i]) * path.steps[i];
      rescaled.SetCentreError(i, k, centre_error);
    }
  }
  *errors = std::move(rescaled);
}

}  // namespace evo::odometry
