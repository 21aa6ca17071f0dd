#include "evo/tracking/ego_motion.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace evo {

namespace {

constexpr std::size_t kFewestFeatures = 12;
constexpr int kIterations = 6;
constexpr double kUsualError = 0.03;       // of a flow, as a share of it,
constexpr double kSmallestErrorPxS = 2.0;  // and besides
constexpr double kLargestError = 0.2;      // of the flow of a resting point, as a share of it,
constexpr double kLargestErrorPxS = 15.0;  // and besides
constexpr double kLargestCost = 0.5;       // of a motion that explains the flows: mean of the robust loss, at most 1
constexpr double kGoodCost = 0.2;          // beyond this another minimum is looked for
constexpr double kNearPx = 10.0;           // closer to where the camera heads than this, slopes are not seen

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

/// Two directions perpendicular to `v` and to one another.
Eigen::Matrix<double, 3, 2> Tangents(const Eigen::Vector3d& v) {
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = v.unitOrthogonal();
  tangents.col(1) = v.cross(tangents.col(0));
  return tangents;
}

double UsualError(const Eigen::Vector2d& flow) { return kSmallestErrorPxS + kUsualError * flow.norm(); }

}  // namespace

double EgoMotion::Refine(const std::vector<FlowSample>& features, const std::vector<PixelGeometry>& pixels) {
  double cost = 1.0;
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    Matrix5d normal = 1e-9 * Matrix5d::Identity();
    Vector5d right = Vector5d::Zero();
    cost = 0.0;
    const Eigen::Matrix<double, 3, 2> tangents = Tangents(direction_);
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (!pixels[i].known()) continue;
      // What is left of the flow across the line along which translation moves the point.
      const Eigen::Vector2d flow = WithoutTurn(pixels[i], features[i].flow);
      const Eigen::Vector2d away = Away(pixels[i]);
      const double length = std::max(away.norm(), 1e-3 * lens_.focal_px());
      const Eigen::Vector2d across(-away.y() / length, away.x() / length);
      const double usual = UsualError(features[i].flow);
      const double residual = across.dot(flow) / usual;
      const double weight = 1.0 / (1.0 + residual * residual);
      cost += (1.0 - weight) / static_cast<double>(features.size());
      Vector5d row;
      // Turning the line by an angle takes that angle times the flow along it off the residual.
      Eigen::Matrix<double, 2, 3> by_direction;
      by_direction << -Eigen::Matrix2d::Identity(), pixels[i].normalized;
      const double along = away.dot(flow) / length;
      row.head<2>() =
          -along / length * (across.transpose() * pixels[i].by_normalized * by_direction * tangents).transpose();
      row.tail<3>() = -(across.transpose() * pixels[i].by_rotation).transpose();
      row /= usual;
      normal += weight * row * row.transpose();
      right -= weight * residual * row;
    }
    if (iteration == kIterations) break;
    normal.diagonal().head<2>().array() += 1e-3 * std::max(normal(0, 0), normal(1, 1)) + 1e-6;
    const Vector5d step = normal.ldlt().solve(right);
    if (!step.allFinite()) return 1.0;
    direction_ = (direction_ + tangents * step.head<2>()).normalized();
    turn_rate_ += step.tail<3>();
  }
  return cost;
}

void EgoMotion::Update(const std::vector<FlowSample>& features) {
  const bool was_known = known_;
  known_ = false;
  if (features.size() < kFewestFeatures) return;
  std::vector<PixelGeometry> pixels;
  for (const auto& feature : features) pixels.push_back(lens_.At(feature.position));

  std::vector<Eigen::Vector3d> starts{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
  if (was_known) starts.insert(starts.begin(), direction_);
  const Eigen::Vector3d turn_rate = was_known ? turn_rate_ : Eigen::Vector3d::Zero();
  double best = kLargestCost;
  Eigen::Vector3d best_direction = starts[0], best_turn_rate = turn_rate;
  for (const auto& start : starts) {
    direction_ = start;
    turn_rate_ = turn_rate;
    const double cost = Refine(features, pixels);
    if (cost < best) {
      best = cost;
      best_direction = direction_;
      best_turn_rate = turn_rate_;
      known_ = true;
    }
    if (was_known && best < kGoodCost) break;
  }
  direction_ = best_direction;
  turn_rate_ = best_turn_rate;
  Orient(features, pixels);
}

void EgoMotion::Orient(const std::vector<FlowSample>& features, const std::vector<PixelGeometry>& pixels) {
  std::size_t departing = 0, nearing = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Eigen::Vector2d flow = WithoutTurn(pixels[i], features[i].flow);
    const double along = Away(pixels[i]).normalized().dot(flow);
    const double usual = 2.0 * UsualError(features[i].flow);
    if (along > usual) ++departing;
    if (along < -usual) ++nearing;
  }
  // Points lie in front of the camera, so they depart from where it heads.
  if (nearing > departing) direction_ = -direction_;
  if (departing + nearing < kFewestFeatures / 2) known_ = false;  // it stands, or only turns
}

PatchFlow EgoMotion::At(const FlowSample& feature, const Eigen::Vector2d& slope) const {
  if (!known_) return {};
  const PixelGeometry pixel = lens_.At(feature.position);
  const Eigen::Vector2d away = Away(pixel);
  const Eigen::Vector2d flow = WithoutTurn(pixel, feature.flow);
  const double inverse_depth = std::max(0.0, away.dot(flow)) / (away.squaredNorm() + kNearPx * kNearPx);
  PatchFlow patch;
  patch.acceleration = 2.0 * inverse_depth * direction_.z() * flow;
  constexpr double kStep = 2.0 * LensGrid::kSpacingPx;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
    const PixelGeometry there = lens_.At(feature.position + step), back = lens_.At(feature.position - step);
    if (!there.known() || !back.known()) return {};
    const auto plane_flow = [&](const PixelGeometry& at, const Eigen::Vector2d& from_centre) -> Eigen::Vector2d {
      return at.by_rotation * turn_rate_ + (inverse_depth + slope.dot(from_centre)) * Away(at);
    };
    patch.rate.col(axis) = (plane_flow(there, step) - plane_flow(back, -step)) / (2.0 * kStep);
  }
  patch.bend = direction_.z() * slope;
  return patch;
}

bool EgoMotion::Allows(const FlowSample& feature) const {
  if (!known_) return true;
  const PixelGeometry pixel = lens_.At(feature.position);
  const Eigen::Vector2d away = Away(pixel).normalized();
  const Eigen::Vector2d flow = WithoutTurn(pixel, feature.flow);
  const double across = away.x() * flow.y() - away.y() * flow.x();
  const double most = kLargestErrorPxS + kLargestError * feature.flow.norm();
  return std::abs(across) <= most && away.dot(flow) >= -most;
}

Eigen::Vector2d EgoMotion::SlopeOf(const Eigen::Vector2d& position, const Eigen::Matrix2d& rate) const {
  if (!known_) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d away = Away(lens_.At(position));
  return rate.transpose() * away / (away.squaredNorm() + kNearPx * kNearPx);
}

}  // namespace evo
