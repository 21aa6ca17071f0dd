#include "tracking/smoothing/rotation_spline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "evo/core/robust.hpp"
#include "tracking/smoothing/cubic_b_spline.hpp"
#include "tracking/smoothing/rotation_spline_equations.hpp"

namespace evo::tracking {

namespace {

constexpr double kKnotIntervalS = 0.02;      // follows vibrations of up to about 20 Hz
constexpr double kSensorBlurS = 0.016;       // half window that averages like the sensor's slow response
constexpr double kMaxHalfWindowKnots = 4.0;  // longer windows are treated like this: their support would be longer
constexpr double kInstantKnots = 1e-3;       // a shorter half window is an instant
constexpr double kChordRatio = 0.77;         // a window's mean slope is about that of the chord over this part of it
constexpr std::array<double, 5> kPositionDifference{1.0, -4.0, 6.0, -4.0, 1.0};
constexpr std::array<double, 3> kFlowDifference{1.0, -2.0, 1.0};
constexpr double kMaxFrameKnots = 1.2501;   // longer frame intervals do not show the fast rotation
constexpr double kDifferenceScalePx = 1.0;  // width of the robust loss
constexpr double kPriorPx = 0.5;            // typical size of the fast rotation
constexpr int kIterations = 2;              // of the reweighting

using RotationJacobian = Eigen::Matrix<double, 2, 3>;
using KnotWeights = std::array<double, kSplineSupport>;

/// An observation, and how it depends on the coefficients of the knots from `first` on.
struct Sample {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< px
  Eigen::Vector2d flow = Eigen::Vector2d::Zero();      ///< px/s
  RotationJacobian jacobian = RotationJacobian::Zero();
  double half_s = 0.0;   ///< half of the window
  double t_knots = 0.0;  ///< stamp
  int first = 0;
  KnotWeights instant{};  ///< the spline at the stamp
  KnotWeights window{};   ///< its mean over the window
  KnotWeights slope{};    ///< its mean slope over the window, 1/s
};

/// Estimates the rotation spline of one segment of time.
class RotationSplineEstimator {
 public:
  /// `tracks`: the observations of the segment, ordered by time.
  RotationSplineEstimator(const JacobianTable& jacobians, std::span<const events::TrackObservation> tracks,
                          std::span<const ObservedWindow> windows)
      : jacobians_(jacobians), tracks_(tracks), windows_(windows) {
    const auto second = std::ranges::upper_bound(tracks_, tracks_.front().t, {}, &events::TrackObservation::t);
    if (second != tracks_.end()) {
      const double frame_s = ToSeconds(second->t - tracks_.front().t);
      stride_ = static_cast<std::size_t>(std::clamp(kKnotIntervalS / frame_s + 0.5, 1.0, 1000.0));
    }
    const auto knots = static_cast<std::size_t>(InKnots(tracks_.back().t)) + 2 * kSplineSupport;
    coefficients_.assign(knots, Eigen::Vector3d::Zero());
    CollectDifferences();
    for (int iteration = 0; iteration < kIterations; ++iteration) Refine();
  }

  /// The position of observation `index` at its very stamp, px.
  Eigen::Vector2d RestoredPosition(std::size_t index) const {
    const Sample sample = MakeSample(index);
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
    for (int k = 0; k < kSplineSupport; ++k) {
      rotation += (sample.instant[k] - sample.window[k]) * coefficients_[sample.first + k];
    }
    return sample.position + sample.jacobian * rotation;
  }

 private:
  double InKnots(TimeNs t) const { return ToSeconds(t - tracks_.front().t) / kKnotIntervalS; }

  /// Image motion, px, by a rotation that moves the image's centre by one px.
  RotationJacobian JacobianAt(const events::TrackObservation& o) const {
    return jacobians_.Lookup({o.x, o.y}).J_pixel_rotation / jacobians_.focal_px();
  }

  Sample MakeSample(std::size_t index) const {
    const events::TrackObservation& observation = tracks_[index];
    const ObservedWindow& window = windows_[index];
    Sample sample{.position = {observation.x, observation.y},
                  .flow = window.flow.cast<double>(),
                  .jacobian = JacobianAt(observation),
                  .half_s = window.half_s,
                  .t_knots = InKnots(observation.t)};
    const double u = sample.t_knots;
    const double max_half_s = kMaxHalfWindowKnots * kKnotIntervalS;
    const bool is_instant = sample.half_s <= kInstantKnots * kKnotIntervalS;
    const double half = std::min(std::hypot(sample.half_s, kSensorBlurS), max_half_s) / kKnotIntervalS;
    const double chord = kChordRatio * std::min(sample.half_s, max_half_s) / kKnotIntervalS;
    const int first = static_cast<int>(std::floor(u)) - kSplineSupport / 2 + 1;
    for (int k = 0; k < kSplineSupport; ++k) {
      const double distance = u - (first + k);
      sample.instant[k] = CubicBSpline(distance);
      sample.window[k] = sample.instant[k];
      if (is_instant) continue;
      sample.window[k] = (CubicBSplineIntegral(distance + half) - CubicBSplineIntegral(distance - half)) / (2.0 * half);
      sample.slope[k] =
          (CubicBSpline(distance + chord) - CubicBSpline(distance - chord)) / (2.0 * chord * kKnotIntervalS);
    }
    sample.first = first + kSplineSupport;  // the knots begin this long before the first stamp
    return sample;
  }

  void CollectDifferences() {
    std::vector<std::size_t> order(tracks_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return tracks_[i].id; });
    std::vector<Sample> samples;  // of a track
    for (std::size_t i = 0; i < order.size(); ++i) {
      samples.push_back(MakeSample(order[i]));
      if (i + 1 < order.size() && tracks_[order[i + 1]].id == tracks_[order[i]].id) continue;
      CollectTrackDifferences(samples);
      samples.clear();
    }
  }

  void CollectTrackDifferences(std::span<const Sample> track) {
    for (std::size_t i = 0; i + 2 * stride_ < track.size(); ++i) {
      // A flow is taken as the displacement within half a window, whose error equals that of a position.
      const double half_s = track[i + stride_].half_s;
      if (half_s > 0.0) AddDifference(track.subspan(i), half_s, kFlowDifference, &Sample::flow, &Sample::slope);
      if (i + 4 * stride_ >= track.size()) continue;
      AddDifference(track.subspan(i), 1.0, kPositionDifference, &Sample::position, &Sample::window);
    }
  }

  template <std::size_t kSize>
  void AddDifference(std::span<const Sample> samples, double unit, const std::array<double, kSize>& factors,
                     Eigen::Vector2d Sample::*value, KnotWeights Sample::*weights) {
    const Sample& first = samples.front();
    const double duration = samples[(kSize - 1) * stride_].t_knots - first.t_knots;
    if (duration > (kSize - 1) * kMaxFrameKnots) return;
    TrackDifference difference{.jacobian = samples[kSize / 2 * stride_].jacobian.cast<float>(), .first = first.first};
    for (std::size_t d = 0; d < kSize; ++d) {
      const Sample& sample = samples[d * stride_];
      const double factor = unit * factors[d];
      difference.value += (factor * sample.*value).template cast<float>();
      float* const sum = difference.weights.data() + (sample.first - first.first);
      for (int k = 0; k < kSplineSupport; ++k) sum[k] += static_cast<float>(factor * (sample.*weights)[k]);
    }
    differences_.push_back(difference);
  }

  void Refine() {
    RotationSplineEquations equations(coefficients_.size());
    for (const TrackDifference& difference : differences_) {
      Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
      for (int k = 0; k < kSplineSpan; ++k) {
        if (difference.weights[k] != 0.0f) rotation += difference.weights[k] * coefficients_[difference.first + k];
      }
      const Eigen::Vector2f residual = difference.value - difference.jacobian * rotation.cast<float>();
      equations.Add(difference, CauchyWeight(residual.squaredNorm() / (kDifferenceScalePx * kDifferenceScalePx)));
    }
    coefficients_ = equations.Solve(kPriorPx);
  }

  const JacobianTable& jacobians_;
  std::span<const events::TrackObservation> tracks_;
  std::span<const ObservedWindow> windows_;
  std::size_t stride_ = 1;  // frames from one knot to the next
  std::vector<TrackDifference> differences_;
  std::vector<Eigen::Vector3d> coefficients_;  // px
};

}  // namespace

void RestoreRotation(const geometry::Camera& camera, const JacobianTable& jacobians,
                     std::span<const events::TrackObservation> observed, std::span<const ObservedWindow> windows,
                     std::size_t first, std::span<events::TrackObservation> restored) {
  if (restored.empty()) return;
  if (std::ranges::all_of(windows, [](const ObservedWindow& window) { return window.half_s == 0.0f; })) return;
  const RotationSplineEstimator estimator(jacobians, observed, windows);
  for (std::size_t i = 0; i < restored.size(); ++i) {
    const Eigen::Vector2d position = estimator.RestoredPosition(first + i);
    if (!camera.Contains(position)) continue;
    restored[i].x = position.x();
    restored[i].y = position.y();
  }
}

}  // namespace evo::tracking
