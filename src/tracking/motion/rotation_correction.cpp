#include "tracking/motion/rotation_correction.hpp"

#include <cmath>
#include <vector>

#include "tracking/motion/robust_linear.hpp"

namespace evo::tracking {

namespace {

constexpr std::size_t kMinFeatures = 12;  // for three unknowns and outliers
constexpr int kIterations = 5;
constexpr double kOffsetWidthPx = 1.0;  // of the robust loss
constexpr double kFlowWidthPxS = 20.0;  // of the robust loss
constexpr double kPrior = 1.0;          // (px/rad)^2: zero about an axis that the features hardly observe

Eigen::Vector3d CommonRotation(std::span<const PredictionResidual> residuals,
                               Eigen::Vector2d PredictionResidual::*value, double width) {
  std::vector<LinearMeasurement<2, 3>> measurements;
  for (const auto& residual : residuals) measurements.push_back({residual.J_pixel_rotation, residual.*value});
  return SolveRobust<2, 3>(measurements, Eigen::Vector3d::Constant(kPrior), width, kIterations);
}

}  // namespace

RotationCorrection EstimateRotationCorrection(std::span<const PredictionResidual> residuals) {
  if (residuals.size() < kMinFeatures) return {};
  RotationCorrection correction{
      .rotation = CommonRotation(residuals, &PredictionResidual::offset, kOffsetWidthPx),
      .angular_velocity = CommonRotation(residuals, &PredictionResidual::flow, kFlowWidthPxS)};
  double squares = 0.0;
  for (const auto& residual : residuals) squares += (residual.J_pixel_rotation * correction.rotation).squaredNorm();
  correction.rms_motion_px = std::sqrt(squares / static_cast<double>(residuals.size()));
  return correction;
}

}  // namespace evo::tracking
