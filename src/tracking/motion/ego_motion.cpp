#include "tracking/motion/ego_motion.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "evo/core/robust.hpp"

namespace evo::tracking {

namespace {

constexpr std::size_t kMinFeatures = 12;  // for five unknowns and outliers

// Search.
constexpr int kIterations = 6;     // of Gauss-Newton, from each start
constexpr double kMaxCost = 0.5;   // mean robust loss, at most 1, of a motion that explains the flows
constexpr double kGoodCost = 0.2;  // beyond this the search tries one other direction a frame,
constexpr double kFairCost = 0.4;  // and beyond this all directions
constexpr double kRidge = 1e-9;    // keeps the normal equations regular without flows
constexpr double kDamping = 1e-3;  // of the direction, relative to the normal equations,
constexpr double kMinDamping = 1e-6;
constexpr double kMinTranslationalFlow = 1e-3;  // on the plane z = 1, 1/s; nearer to the focus lines are ill defined

// Standard deviation of a flow along one axis.
constexpr double kFlowErrorRatio = 0.03;  // of the flow
constexpr double kFlowErrorPxS = 2.0;     // added to it

// Kalman filter.
constexpr int kFilterIterations = 2;           // from next to the solution
constexpr double kDirectionNoise = 0.014;      // rad/sqrt(s)
constexpr double kAngularVelocityNoise = 0.2;  // rad/s/sqrt(s)
constexpr double kVarianceInflation = 3.0;     // errors of flows are correlated
constexpr double kMinStepS = 1e-3;             // of a repeated stamp: the covariance must grow
constexpr double kMinDirectionCosine = 0.9;    // between two directions of one motion: 26 degrees
constexpr double kAccelerationGain = 0.2;      // weight of one frame in the typical angular acceleration

// Static points.
constexpr double kMaxStaticErrorRatio = 0.2;  // of the flow
constexpr double kMaxStaticErrorPxS = 15.0;   // added to it
constexpr double kProjectionGain = 0.7;       // the motion has errors too, so a part of the flow's error stays
constexpr double kMaxProjectionSigmas = 4.0;  // where the projection halves: the point may not be static
constexpr double kFocusOfExpansionPx = 10.0;  // within this radius inverse depths are unobservable

using Matrix5d = Eigen::Matrix<double, 5, 5>;
using Matrix65d = Eigen::Matrix<double, 6, 5>;

/// Derivative of (direction, angular velocity) by a step of the motion.
Matrix65d StepJacobian(const CameraMotion::Tangents& tangents) {
  Matrix65d J_motion_step = Matrix65d::Zero();
  J_motion_step.topLeftCorner<3, 2>() = tangents;
  J_motion_step.bottomRightCorner<3, 3>().setIdentity();
  return J_motion_step;
}

double InverseDepth(const CameraMotion& motion, const PixelJacobians& pixel, const Eigen::Vector2d& flow) {
  const Eigen::Vector2d line = motion.TranslationalFlow(pixel);
  return std::max(0.0, line.dot(motion.Derotate(pixel, flow))) /
         (line.squaredNorm() + kFocusOfExpansionPx * kFocusOfExpansionPx);
}

double FlowError(const Eigen::Vector2d& flow) { return kFlowErrorPxS + kFlowErrorRatio * flow.norm(); }

}  // namespace

double EgoMotion::Refine(const std::vector<FlowSample>& features, const std::vector<PixelJacobians>& pixels,
                         const Prior& prior, int iterations) {
  const double min_flow = kMinTranslationalFlow * jacobians_.focal_px();
  double cost = 1.0;
  for (int iteration = 0; iteration <= iterations; ++iteration) {
    const CameraMotion::Tangents tangents = motion_.DirectionTangents();
    const Matrix65d J_motion_step = StepJacobian(tangents);
    geometry::Vector6d innovation;
    innovation << motion_.direction - prior.motion.direction, motion_.angular_velocity - prior.motion.angular_velocity;
    Matrix5d normal = kRidge * Matrix5d::Identity() + J_motion_step.transpose() * prior.information * J_motion_step;
    CameraMotion::Step right = -J_motion_step.transpose() * (prior.information * innovation);
    cost = 0.0;
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (!pixels[i].known()) continue;
      const EpipolarResidual epipolar =
          ComputeEpipolarResidual(features[i].flow, pixels[i], motion_, tangents, min_flow);
      const double sigma = FlowError(features[i].flow);
      const double residual = epipolar.value / sigma;
      const double weight = CauchyWeight(residual * residual);
      cost += 1.0 - weight;
      const CameraMotion::Step row = epipolar.jacobian / sigma;
      normal += weight * row * row.transpose();
      right -= weight * residual * row;
    }
    cost /= static_cast<double>(features.size());
    if (iteration == iterations) {
      covariance_ = kVarianceInflation * J_motion_step * normal.inverse() * J_motion_step.transpose();
      break;
    }
    normal.diagonal().head<2>().array() += kDamping * std::max(normal(0, 0), normal(1, 1)) + kMinDamping;
    const CameraMotion::Step step = normal.ldlt().solve(right);
    if (!step.allFinite()) return 1.0;
    motion_ = motion_.Retract(tangents, step);
  }
  return cost;
}

std::vector<Eigen::Vector3d> EgoMotion::StartDirections() {
  std::vector<Eigen::Vector3d> starts{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
  if (known_) {
    std::ranges::rotate(starts, starts.begin() + static_cast<std::ptrdiff_t>(next_start_++ % starts.size()));
    starts.insert(starts.begin(), motion_.direction);
  }
  return starts;
}

void EgoMotion::Search(const std::vector<FlowSample>& features, const std::vector<PixelJacobians>& pixels) {
  const bool was_known = known_;
  const std::vector<Eigen::Vector3d> starts = StartDirections();
  const Eigen::Vector3d angular_velocity = was_known ? motion_.angular_velocity : Eigen::Vector3d::Zero();
  known_ = false;
  double best_cost = kMaxCost;
  CameraMotion best{starts[0], angular_velocity};
  for (std::size_t i = 0; i < starts.size(); ++i) {
    motion_ = {starts[i], angular_velocity};
    const double cost = Refine(features, pixels, {}, kIterations);
    if (cost < best_cost) {
      best_cost = cost;
      best = motion_;
      known_ = true;
    }
    // A motion that still explains the flows ends the search; a fair one is compared with one other direction a frame.
    if (was_known && best_cost < (i == 0 ? kGoodCost : kFairCost)) break;
  }
  motion_ = best;
  ResolveSign(features, pixels);
}

void EgoMotion::Update(const std::vector<FlowSample>& features, double step_s) {
  const bool was_known = known_;
  const CameraMotion before = motion_;
  const geometry::Matrix6d covariance_before = covariance_;
  if (features.size() < kMinFeatures) {
    known_ = false;
    return;
  }
  std::vector<PixelJacobians> pixels;
  for (const auto& feature : features) pixels.push_back(jacobians_.Lookup(feature.position));
  Search(features, pixels);
  if (!known_) return;
  Prior prior;
  if (was_known && before.direction.dot(motion_.direction) > kMinDirectionCosine) {
    geometry::Vector6d noise;
    noise << Eigen::Vector3d::Constant(kDirectionNoise), Eigen::Vector3d::Constant(kAngularVelocityNoise);
    geometry::Matrix6d covariance = covariance_before;
    covariance.diagonal() += std::max(step_s, kMinStepS) * noise.cwiseAbs2();
    prior = {before, kVarianceInflation * covariance.inverse()};
  }
  Refine(features, pixels, prior, kFilterIterations);
  if (was_known && step_s > 0.0) {
    const double acceleration = (motion_.angular_velocity - before.angular_velocity).norm() / step_s;
    typical_angular_acceleration_ += kAccelerationGain * (acceleration - typical_angular_acceleration_);
  }
}

void EgoMotion::ResolveSign(const std::vector<FlowSample>& features, const std::vector<PixelJacobians>& pixels) {
  std::size_t departing = 0, approaching = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Eigen::Vector2d derotated = motion_.Derotate(pixels[i], features[i].flow);
    const double along = motion_.TranslationalFlow(pixels[i]).normalized().dot(derotated);
    const double significant = 2.0 * FlowError(features[i].flow);
    if (along > significant) ++departing;
    if (along < -significant) ++approaching;
  }
  // Points lie in front of the camera, so they depart from the focus of expansion.
  if (approaching > departing) motion_.direction = -motion_.direction;
  if (departing + approaching < kMinFeatures / 2) known_ = false;  // the camera stands or only rotates
}

Eigen::Vector2d EgoMotion::ProjectToEpipolarLine(const FlowSample& feature) const {
  if (!known_) return feature.flow;
  const PixelJacobians pixel = jacobians_.Lookup(feature.position);
  const Eigen::Vector2d line = motion_.TranslationalFlow(pixel);
  const Eigen::Vector2d normal(-line.y(), line.x());
  const Eigen::Vector2d across = normal.dot(motion_.Derotate(pixel, feature.flow)) /
                                 std::max(line.squaredNorm(), kFocusOfExpansionPx * kFocusOfExpansionPx) * normal;
  const double width = kMaxProjectionSigmas * FlowError(feature.flow);
  // Not CauchyWeight, whose product with the gain rounds differently.
  return feature.flow - kProjectionGain / (1.0 + across.squaredNorm() / (width * width)) * across;
}

double EgoMotion::EstimateInverseDepth(const FlowSample& feature) const {
  return known_ ? InverseDepth(motion_, jacobians_.Lookup(feature.position), feature.flow) : 0.0;
}

PatchFlow EgoMotion::PredictPatchFlow(const FlowSample& feature, const Eigen::Vector2d& inverse_depth_gradient) const {
  if (!known_) return {};
  const PixelJacobians pixel = jacobians_.Lookup(feature.position);
  const Eigen::Vector2d translational_flow = motion_.TranslationalFlow(pixel);
  const double inverse_depth = InverseDepth(motion_, pixel, feature.flow);
  PatchFlow patch;
  constexpr double kStep = 2.0 * JacobianTable::kSpacingPx;  // of central differences, which include the lens
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
    const PixelJacobians ahead = jacobians_.Lookup(feature.position + step);
    const PixelJacobians behind = jacobians_.Lookup(feature.position - step);
    if (!ahead.known() || !behind.known()) return {};
    const auto plane_flow = [&](const PixelJacobians& at, const Eigen::Vector2d& from_centre) -> Eigen::Vector2d {
      return motion_.PredictFlow(at, inverse_depth + inverse_depth_gradient.dot(from_centre));
    };
    patch.linear_rate.col(axis) = (plane_flow(ahead, step) - plane_flow(behind, -step)) / (2.0 * kStep);
  }
  patch.quadratic_rate = motion_.direction.z() * inverse_depth_gradient;
  // The flow changes as the point moves through the image, where the lens changes, and as the point comes nearer.
  patch.acceleration = (patch.linear_rate - translational_flow * inverse_depth_gradient.transpose()) * feature.flow +
                       inverse_depth * inverse_depth * motion_.direction.z() * translational_flow;
  return patch;
}

bool EgoMotion::MayBeStatic(const FlowSample& feature) const {
  if (!known_) return true;
  const PixelJacobians pixel = jacobians_.Lookup(feature.position);
  const Eigen::Vector2d line = motion_.TranslationalFlow(pixel).normalized();
  const Eigen::Vector2d derotated = motion_.Derotate(pixel, feature.flow);
  const double across = line.x() * derotated.y() - line.y() * derotated.x();
  const double max_error = kMaxStaticErrorPxS + kMaxStaticErrorRatio * feature.flow.norm();
  return std::abs(across) <= max_error && line.dot(derotated) >= -max_error;
}

Eigen::Vector2d EgoMotion::EstimateInverseDepthGradient(const Eigen::Vector2d& position,
                                                        const Eigen::Matrix2d& residual_rate) const {
  if (!known_) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d line = motion_.TranslationalFlow(jacobians_.Lookup(position));
  return residual_rate.transpose() * line / (line.squaredNorm() + kFocusOfExpansionPx * kFocusOfExpansionPx);
}

}  // namespace evo::tracking
