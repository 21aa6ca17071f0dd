#include "tracking/motion/epipolar_filter.hpp"

#include <algorithm>
#include <cmath>

#include "evo/core/robust.hpp"
#include "tracking/motion/robust_linear.hpp"

namespace evo::tracking {

namespace {

constexpr std::ptrdiff_t kMinFeatures = 20;  // for five unknowns and outliers
constexpr int kIterations = 6;
constexpr double kFocusOfExpansionPx = 20.0;   // within this radius the lines are ill defined
constexpr double kDeviationWidthPx = 0.2;      // of the robust loss
constexpr double kPositionErrorPx = 0.4;       // standard deviation across the line
constexpr double kStaticWidthPx = 1.0;         // a larger deviation counts less and less as an error
constexpr double kRotationPrior = 1.0;         // (px/rad)^2
constexpr double kDirectionPriorRad = 0.3;     // standard deviation
constexpr double kDirectionChangeGain = 0.05;  // of one frame in the typical change of direction
constexpr double kMaxDirectionChange = 0.5;    // rad

using Correction = EpipolarDeviation::Correction;

/// The correction of rotation and direction that explains the deviations best.
Correction FitCorrection(const std::vector<EpipolarDeviation>& deviations) {
  Correction prior;
  prior << Eigen::Vector3d::Constant(kRotationPrior),
      Eigen::Vector2d::Constant(std::pow(kDeviationWidthPx / kDirectionPriorRad, 2));
  std::vector<LinearMeasurement<1, 5>> measurements;
  for (const auto& deviation : deviations) {
    if (!deviation.observable()) continue;
    measurements.push_back({deviation.jacobian.transpose(), Eigen::Matrix<double, 1, 1>::Constant(deviation.value)});
  }
  return SolveRobust<1, 5>(measurements, prior, kDeviationWidthPx, kIterations);
}

/// Gain of a Kalman filter in its steady state. `ratio`: the variance of a change in one step over that of a position.
double SteadyStateGain(double ratio) { return 0.5 * (std::sqrt(ratio * ratio + 4.0 * ratio) - ratio); }

}  // namespace

EpipolarDeviation ComputeEpipolarDeviation(const CameraMotion& motion, const CameraMotion::Tangents& tangents,
                                           const JacobianTable& jacobians, double step_s, const FeatureStep& step) {
  const PixelJacobians pixel = jacobians.Lookup(0.5 * (step.previous + step.measured));
  const Eigen::Vector2d line = motion.TranslationalFlow(pixel);
  if (!pixel.known() || line.norm() < kFocusOfExpansionPx) return {};
  EpipolarDeviation deviation;
  deviation.normal = Eigen::Vector2d(-line.y(), line.x()).normalized();
  deviation.value = deviation.normal.dot(step.measured - step.previous);
  deviation.baseline_px = step_s * step.inverse_depth * line.norm();
  const Eigen::Matrix<double, 2, 3> J_flow_direction =
      pixel.J_pixel_normalized * CameraMotion::DirectionJacobian(pixel);
  deviation.jacobian << pixel.J_pixel_rotation.transpose() * deviation.normal,
      step_s * step.inverse_depth * tangents.transpose() * J_flow_direction.transpose() * deviation.normal;
  return deviation;
}

std::vector<Eigen::Vector2d> EpipolarFilter::Filter(const CameraMotion& motion, const JacobianTable& jacobians,
                                                    double step_s, std::span<const FeatureStep> steps) {
  const CameraMotion::Tangents tangents = motion.DirectionTangents();
  std::vector<EpipolarDeviation> deviations;
  std::vector<Eigen::Vector2d> positions;
  for (const auto& step : steps) {
    deviations.push_back(ComputeEpipolarDeviation(motion, tangents, jacobians, step_s, step));
    positions.push_back(step.measured);
  }
  if (std::ranges::count_if(deviations, &EpipolarDeviation::observable) < kMinFeatures) return positions;
  const Correction correction = FitCorrection(deviations);
  if (!correction.allFinite()) return positions;
  direction_change_ +=
      kDirectionChangeGain * (std::min(correction.tail<2>().norm(), kMaxDirectionChange) - direction_change_);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const EpipolarDeviation& deviation = deviations[i];
    if (!deviation.observable()) continue;
    const double error = deviation.value - deviation.jacobian.dot(correction);
    const double gain = SteadyStateGain(std::pow(deviation.baseline_px * direction_change_ / kPositionErrorPx, 2));
    const double static_weight = CauchyWeight(std::pow(error / kStaticWidthPx, 2));
    positions[i] -= (1.0 - gain) * static_weight * error * deviation.normal;
  }
  return positions;
}

}  // namespace evo::tracking
