#include "tracking/motion/epipolar_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace evo::tracking {

namespace {

constexpr std::size_t kFewestFeatures = 20;
constexpr int kIterations = 6;
constexpr double kNearHeadingPx = 20.0;    // there the lines mean little
constexpr double kUsualDeviationPx = 0.2;  // beyond this a feature says less about the camera
constexpr double kErrorPx = 0.4;           // of positions across their lines
constexpr double kOwnMotionPx = 1.0;       // beyond this a deviation is less and less taken for an error
constexpr double kTurnPrior = 1.0;         // px^2
constexpr double kHeadingPrior = 0.3;      // rad
constexpr double kMemory = 0.05;           // of the usual change of the heading, share of one frame
constexpr double kMostChange = 0.5;        // rad

using Change = Eigen::Matrix<double, 5, 1>;  // turn (rad), heading along both tangents (rad)

struct Deviation {
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  // of the line
  double value = 0.0;                                // px along it
  Change derivative = Change::Zero();
  double way_px = 0.0;  // that the translation moves the feature in this step

  bool counts() const { return way_px > 0.0; }
};

Deviation MakeDeviation(const CameraMotion& motion, const CameraMotion::Tangents& tangents, const LensGrid& lens,
                        double step_s, const FeatureStep& step) {
  const PixelGeometry pixel = lens.At(0.5 * (step.before + step.now));
  const Eigen::Vector2d away = motion.Away(pixel);
  if (!pixel.known() || away.norm() < kNearHeadingPx) return {};
  Deviation deviation;
  deviation.normal = Eigen::Vector2d(-away.y(), away.x()).normalized();
  deviation.value = deviation.normal.dot(step.now - step.before);
  deviation.way_px = step_s * step.inverse_depth * away.norm();
  const Eigen::Matrix<double, 2, 3> by_direction = pixel.by_normalized * CameraMotion::AwayByDirection(pixel);
  deviation.derivative << pixel.by_rotation.transpose() * deviation.normal,
      step_s * step.inverse_depth * tangents.transpose() * by_direction.transpose() * deviation.normal;
  return deviation;
}

/// The turn and the change of the heading that explain the deviations best.
Change Explain(const std::vector<Deviation>& deviations) {
  Change prior;
  prior << Eigen::Vector3d::Constant(kTurnPrior),
      Eigen::Vector2d::Constant(std::pow(kUsualDeviationPx / kHeadingPrior, 2));
  Change change = Change::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix<double, 5, 5> normal = prior.asDiagonal();
    Change right = Change::Zero();
    for (const auto& deviation : deviations) {
      if (!deviation.counts()) continue;
      const double left = (deviation.value - deviation.derivative.dot(change)) / kUsualDeviationPx;
      const double weight = 1.0 / (1.0 + left * left);
      normal += weight * deviation.derivative * deviation.derivative.transpose();
      right += weight * deviation.derivative * deviation.value;
    }
    change = normal.ldlt().solve(right);
  }
  return change;
}

/// Of a Kalman filter in its steady state, for variances of what changes in a step over that of a position.
double SteadyGain(double ratio) { return 0.5 * (std::sqrt(ratio * ratio + 4.0 * ratio) - ratio); }

}  // namespace

std::vector<Eigen::Vector2d> EpipolarFilter::Filter(const CameraMotion& motion, const LensGrid& lens, double step_s,
                                                    std::span<const FeatureStep> steps) {
  const CameraMotion::Tangents tangents = motion.DirectionTangents();
  std::vector<Deviation> deviations;
  std::vector<Eigen::Vector2d> positions;
  for (const auto& step : steps) {
    deviations.push_back(MakeDeviation(motion, tangents, lens, step_s, step));
    positions.push_back(step.now);
  }
  const auto count = std::ranges::count_if(deviations, &Deviation::counts);
  if (count < static_cast<std::ptrdiff_t>(kFewestFeatures)) return positions;
  const Change change = Explain(deviations);
  if (!change.allFinite()) return positions;
  heading_change_ += kMemory * (std::min(change.tail<2>().norm(), kMostChange) - heading_change_);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Deviation& deviation = deviations[i];
    if (!deviation.counts()) continue;
    const double left = deviation.value - deviation.derivative.dot(change);
    const double gain = SteadyGain(std::pow(deviation.way_px * heading_change_ / kErrorPx, 2));
    const double at_rest = 1.0 / (1.0 + std::pow(left / kOwnMotionPx, 2));
    positions[i] -= (1.0 - gain) * at_rest * left * deviation.normal;
  }
  return positions;
}

}  // namespace evo::tracking
