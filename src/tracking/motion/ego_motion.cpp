#include "tracking/motion/ego_motion.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace evo::tracking {

namespace {

constexpr std::size_t kFewestFeatures = 12;
constexpr int kIterations = 6;
constexpr int kFilterIterations = 2;        // from what the flows alone say to the filtered motion
constexpr double kTurnChangeGain = 0.2;     // of one frame in what is usual
constexpr double kDirectionDrift = 0.014;   // of the motion, rad in a second; grows with the root of time
constexpr double kTurnDrift = 0.2;          // the same, of the turn rate, rad/s
constexpr double kAlike = 3.0;              // flows err alike: they tell so much less than if each erred by itself
constexpr double kShortestStepS = 1e-3;     // of the filter
constexpr double kMostTurned = 0.9;         // cosine of the turn of the direction that is not a new motion
constexpr double kUsualError = 0.03;        // of a flow, as a share of it,
constexpr double kSmallestErrorPxS = 2.0;   // and besides
constexpr double kLargestError = 0.2;       // of the flow of a resting point, as a share of it,
constexpr double kLargestErrorPxS = 15.0;   // and besides
constexpr double kLargestCost = 0.5;        // of a motion that explains the flows: mean of the robust loss, at most 1
constexpr double kGoodCost = 0.2;           // beyond this another minimum is looked for,
constexpr double kFairCost = 0.4;           // and beyond this in all directions
constexpr double kCorrected = 0.7;          // share of a flow's error that is corrected, as the motion has errors too,
constexpr double kLargestCorrection = 4.0;  // if it is a few of its usual errors: else the point does not rest
constexpr double kNearPx = 10.0;            // closer to where the camera heads than this, slopes are not seen

using Matrix5d = Eigen::Matrix<double, 5, 5>;
using Vectors = Eigen::Matrix<double, 6, 5>;  // direction and turn rate, by a step of the motion

Vectors VectorsByStep(const CameraMotion::Tangents& tangents) {
  Vectors vectors = Vectors::Zero();
  vectors.topLeftCorner<3, 2>() = tangents;
  vectors.bottomRightCorner<3, 3>().setIdentity();
  return vectors;
}

double InverseDepthOf(const CameraMotion& motion, const PixelGeometry& pixel, const Eigen::Vector2d& flow) {
  const Eigen::Vector2d away = motion.Away(pixel);
  return std::max(0.0, away.dot(motion.WithoutTurn(pixel, flow))) / (away.squaredNorm() + kNearPx * kNearPx);
}

double UsualError(const Eigen::Vector2d& flow) { return kSmallestErrorPxS + kUsualError * flow.norm(); }

}  // namespace

double EgoMotion::Refine(const std::vector<FlowSample>& features, const std::vector<PixelGeometry>& pixels,
                         const Expectation& expected, int iterations) {
  double cost = 1.0;
  for (int iteration = 0; iteration <= iterations; ++iteration) {
    const CameraMotion::Tangents tangents = motion_.DirectionTangents();
    const Vectors by_step = VectorsByStep(tangents);
    geometry::Vector6d unexpected;
    unexpected << motion_.direction - expected.motion.direction, motion_.turn_rate - expected.motion.turn_rate;
    Matrix5d normal = 1e-9 * Matrix5d::Identity() + by_step.transpose() * expected.information * by_step;
    CameraMotion::Step right = -by_step.transpose() * (expected.information * unexpected);
    cost = 0.0;
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (!pixels[i].known()) continue;
      const FlowResidual left = ResidualOf(features[i].flow, pixels[i], motion_, tangents, 1e-3 * lens_.focal_px());
      const double usual = UsualError(features[i].flow);
      const double residual = left.value / usual;
      const double weight = 1.0 / (1.0 + residual * residual);
      cost += 1.0 - weight;
      const CameraMotion::Step row = left.derivative / usual;
      normal += weight * row * row.transpose();
      right -= weight * residual * row;
    }
    cost /= static_cast<double>(features.size());
    if (iteration == iterations) {
      covariance_ = kAlike * by_step * normal.inverse() * by_step.transpose();
      break;
    }
    normal.diagonal().head<2>().array() += 1e-3 * std::max(normal(0, 0), normal(1, 1)) + 1e-6;
    const CameraMotion::Step step = normal.ldlt().solve(right);
    if (!step.allFinite()) return 1.0;
    motion_ = motion_.Moved(tangents, step);
  }
  return cost;
}

void EgoMotion::Update(const std::vector<FlowSample>& features, double step_s) {
  const bool was_known = known_;
  const CameraMotion before = motion_;
  const geometry::Matrix6d covariance_before = covariance_;
  known_ = false;
  if (features.size() < kFewestFeatures) return;
  std::vector<PixelGeometry> pixels;
  for (const auto& feature : features) pixels.push_back(lens_.At(feature.position));

  std::vector<Eigen::Vector3d> starts{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
  if (was_known) {
    std::ranges::rotate(starts, starts.begin() + static_cast<std::ptrdiff_t>(next_start_++ % starts.size()));
    starts.insert(starts.begin(), motion_.direction);
  }
  const Eigen::Vector3d turn_rate = was_known ? motion_.turn_rate : Eigen::Vector3d::Zero();
  double best_cost = kLargestCost;
  CameraMotion best{starts[0], turn_rate};
  for (std::size_t i = 0; i < starts.size(); ++i) {
    motion_ = {starts[i], turn_rate};
    const double cost = Refine(features, pixels, {}, kIterations);
    if (cost < best_cost) {
      best_cost = cost;
      best = motion_;
      known_ = true;
    }
    // For a motion that goes on explaining the flows fairly, another minimum is looked for in one direction a frame.
    if (was_known && best_cost < (i == 0 ? kGoodCost : kFairCost)) break;
  }
  motion_ = best;
  Orient(features, pixels);
  if (!known_) return;
  Expectation expected;
  if (was_known && before.direction.dot(motion_.direction) > kMostTurned) {
    geometry::Vector6d drift;
    drift << Eigen::Vector3d::Constant(kDirectionDrift), Eigen::Vector3d::Constant(kTurnDrift);
    geometry::Matrix6d covariance = covariance_before;
    covariance.diagonal() += std::max(step_s, kShortestStepS) * drift.cwiseAbs2();
    expected = {before, kAlike * covariance.inverse()};
  }
  Refine(features, pixels, expected, kFilterIterations);
  if (was_known && step_s > 0.0) {
    const double change = (motion_.turn_rate - before.turn_rate).norm() / step_s;
    turn_change_ += kTurnChangeGain * (change - turn_change_);
  }
}

Eigen::Vector2d EgoMotion::AtRest(const FlowSample& feature) const {
  if (!known_) return feature.flow;
  const PixelGeometry pixel = lens_.At(feature.position);
  const Eigen::Vector2d away = motion_.Away(pixel);
  const Eigen::Vector2d normal(-away.y(), away.x());
  const Eigen::Vector2d across =
      normal.dot(motion_.WithoutTurn(pixel, feature.flow)) / std::max(away.squaredNorm(), kNearPx * kNearPx) * normal;
  const double most = kLargestCorrection * UsualError(feature.flow);
  return feature.flow - kCorrected / (1.0 + across.squaredNorm() / (most * most)) * across;
}

void EgoMotion::Orient(const std::vector<FlowSample>& features, const std::vector<PixelGeometry>& pixels) {
  std::size_t departing = 0, nearing = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Eigen::Vector2d flow = motion_.WithoutTurn(pixels[i], features[i].flow);
    const double along = motion_.Away(pixels[i]).normalized().dot(flow);
    const double usual = 2.0 * UsualError(features[i].flow);
    if (along > usual) ++departing;
    if (along < -usual) ++nearing;
  }
  // Points lie in front of the camera, so they depart from where it heads.
  if (nearing > departing) motion_.direction = -motion_.direction;
  if (departing + nearing < kFewestFeatures / 2) known_ = false;  // it stands, or only turns
}

double EgoMotion::InverseDepth(const FlowSample& feature) const {
  return known_ ? InverseDepthOf(motion_, lens_.At(feature.position), feature.flow) : 0.0;
}

PatchFlow EgoMotion::At(const FlowSample& feature, const Eigen::Vector2d& slope) const {
  if (!known_) return {};
  const PixelGeometry pixel = lens_.At(feature.position);
  const Eigen::Vector2d away = motion_.Away(pixel);
  const double inverse_depth = InverseDepthOf(motion_, pixel, feature.flow);
  PatchFlow patch;
  constexpr double kStep = 2.0 * LensGrid::kSpacingPx;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
    const PixelGeometry there = lens_.At(feature.position + step), back = lens_.At(feature.position - step);
    if (!there.known() || !back.known()) return {};
    const auto plane_flow = [&](const PixelGeometry& at, const Eigen::Vector2d& from_centre) -> Eigen::Vector2d {
      return motion_.Flow(at, inverse_depth + slope.dot(from_centre));
    };
    patch.rate.col(axis) = (plane_flow(there, step) - plane_flow(back, -step)) / (2.0 * kStep);
  }
  patch.bend = motion_.direction.z() * slope;
  // The flow changes as the point moves through the image, where the lens has its say, and as it comes nearer.
  patch.acceleration = (patch.rate - away * slope.transpose()) * feature.flow +
                       inverse_depth * inverse_depth * motion_.direction.z() * away;
  return patch;
}

bool EgoMotion::Allows(const FlowSample& feature) const {
  if (!known_) return true;
  const PixelGeometry pixel = lens_.At(feature.position);
  const Eigen::Vector2d away = motion_.Away(pixel).normalized();
  const Eigen::Vector2d flow = motion_.WithoutTurn(pixel, feature.flow);
  const double across = away.x() * flow.y() - away.y() * flow.x();
  const double most = kLargestErrorPxS + kLargestError * feature.flow.norm();
  return std::abs(across) <= most && away.dot(flow) >= -most;
}

Eigen::Vector2d EgoMotion::SlopeOf(const Eigen::Vector2d& position, const Eigen::Matrix2d& rate) const {
  if (!known_) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d away = motion_.Away(lens_.At(position));
  return rate.transpose() * away / (away.squaredNorm() + kNearPx * kNearPx);
}

}  // namespace evo::tracking
