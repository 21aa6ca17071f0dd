#include "evaluation/trajectory/pose_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evaluation/trajectory/path_frame.hpp"
#include "evaluation/trajectory/pose_differences.hpp"

namespace evo::evaluation {

namespace {

constexpr double kMinDistance = 1.0;  // m; over a shorter distance a ratio is mostly noise

}  // namespace

std::vector<double> ComputeDistances(const geometry::Trajectory& truth, std::span<const PosePair> pairs) {
  std::vector<double> distances;
  double distance = 0.0;
  Eigen::Vector3d position = pairs.front().T_world_cam_truth.translation();
  auto next = std::ranges::upper_bound(truth, pairs.front().t_truth, {}, &geometry::StampedPose::t);
  const auto advance_to = [&](const Eigen::Vector3d& to) {
    distance += (to - position).norm();
    position = to;
  };
  for (const auto& pair : pairs) {
    for (; next != truth.end() && next->t <= pair.t_truth; ++next) advance_to(next->T_world_cam.translation());
    advance_to(pair.T_world_cam_truth.translation());
    distances.push_back(distance);
  }
  return distances;
}

std::vector<PoseError> ComputeErrors(const geometry::Trajectory& truth, std::span<const PosePair> pairs,
                                     std::span<const double> distances, const Evaluation& evaluation,
                                     const EvaluationOptions& options) {
  PathFrame frame(truth, evaluation.up, options.forward, options.chord_m);
  const PoseDifferences differences = AbsoluteDifferences(pairs);
  std::vector<PoseError> errors;
  errors.reserve(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const PosePair& pair = pairs[i];
    PoseError error;
    error.stamp = pair.t_estimate;
    error.seconds = ToSeconds(pair.t_truth - evaluation.from);
    error.distance = distances[i];
    error.position = frame.Resolve(pair.t_truth, pair.T_world_cam_truth, pair.T_world_cam_estimate.translation());
    error.translation = differences.translation[i];
    error.rotation_deg = differences.rotation[i] * 180.0 / std::numbers::pi;
    errors.push_back(error);
  }
  return errors;
}

ErrorSummary Summarize(std::span<const PoseError> errors, double PositionError::*component) {
  std::vector<double> magnitudes;
  std::vector<double> ratios;
  for (const auto& error : errors) {
    magnitudes.push_back(std::abs(error.position.*component));
    if (error.distance >= kMinDistance) ratios.push_back(magnitudes.back() / error.distance);
  }
  const Statistics statistics = ComputeStatistics(magnitudes);
  return {statistics.mean, statistics.rmse, statistics.max, errors.back().position.*component,
          ComputeStatistics(ratios).mean};
}

}  // namespace evo::evaluation
