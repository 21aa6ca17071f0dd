#include "tracking/smoothing/camera_shake.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "tracking/patch/simd8.hpp"

namespace evo::tracking {

namespace {

constexpr double kKnotS = 0.02;             // of the spline: follows a shake of up to some 20 Hz
constexpr double kSmearS = 0.016;           // half a window that smears like the sensor
constexpr double kLongestHalfWindow = 4.0;  // knots; longer windows are treated like this
constexpr int kWeights = 12;                // knots that such a window depends on
constexpr double kInstant = 1e-3;           // knots; a shorter half window is none
constexpr double kSlopeReach = 0.77;        // the slope over a window is about that of the chord over so much of it
constexpr std::array<double, 5> kPositionDifference{1.0, -4.0, 6.0, -4.0, 1.0};
constexpr std::array<double, 3> kFlowDifference{1.0, -2.0, 1.0};
constexpr double kLongestStep = 1.2501;     // knots from frame to frame; longer ones tell nothing of a shake
constexpr int kSpan = kWeights + 6;         // knots that a difference over four such steps depends on
constexpr double kUsualDifferencePx = 1.0;  // beyond this a difference is taken for an outlier
constexpr double kShakePx = 0.5;            // usual size of the shake
constexpr int kRounds = 2;

using ImageJacobian = Eigen::Matrix<double, 2, 3>;

/// The integral of the cubic B-spline with knots at whole numbers, from minus infinity to `u`.
double SplineIntegral(double u) {
  if (u > 0.0) return 1.0 - SplineIntegral(-u);
  if (u <= -2.0) return 0.0;
  const double square = (2.0 + u) * (2.0 + u);
  if (u <= -1.0) return square * square / 24.0;
  return 0.5 + u * (2.0 / 3.0 - u * u * (1.0 / 3.0 + u / 8.0));
}

double Spline(double u) {
  const double a = std::abs(u);
  if (a >= 2.0) return 0.0;
  return a >= 1.0 ? (2.0 - a) * (2.0 - a) * (2.0 - a) / 6.0 : 2.0 / 3.0 - a * a * (1.0 - 0.5 * a);
}

/// An observation, and how it depends on the coefficients of the knots from `first` on.
struct Sample {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  Eigen::Vector2d flow = Eigen::Vector2d::Zero();  ///< px/s
  ImageJacobian jacobian = ImageJacobian::Zero();
  double half_s = 0.0;  ///< half of the window
  double t_knots = 0.0;
  int first = 0;
  std::array<double, kWeights> instant{};  ///< the spline at the stamp
  std::array<double, kWeights> window{};   ///< its mean over the window
  std::array<double, kWeights> slope{};    ///< its slope over the window, 1/s
};

/// A difference of positions or flows over time, px: the jacobian times the `weights` of the coefficients from `first`
/// on, and noise.
struct Difference {
  Eigen::Vector2f value = Eigen::Vector2f::Zero();
  Eigen::Matrix<float, 2, 3> jacobian;  ///< in the middle
  int first = 0;
  std::array<float, kSpan> weights{};
};

constexpr int kTerms = 6;  // of a symmetric 3 x 3 block: the upper half
constexpr std::array<int, kTerms> kRows{0, 0, 0, 1, 1, 2};
constexpr std::array<int, kTerms> kColumns{0, 1, 2, 1, 2, 2};

/// Adds to the blocks of each of `kSpan` knots with the ones after it (each term in turn) the products of their weights
/// and a block. After the weights follow as many zeros.
EVO_HOT void AddProducts(const std::array<double, 2 * kSpan>& weights, const std::array<double, kTerms>& block,
                         double* terms) {
  for (int i = 0; i < kSpan; ++i) {
    if (weights[i] == 0.0) {
      terms += kTerms * kSpan;
      continue;
    }
    for (const double term : block) {
      const double factor = weights[i] * term;
      for (int d = 0; d < kSpan; ++d) terms[d] += factor * weights[i + d];
      terms += kSpan;
    }
  }
}

/// The normal equations of the spline: a band of symmetric 3 x 3 blocks.
class ShakeEquations {
 public:
  explicit ShakeEquations(std::size_t knots)
      : terms_(knots * kTerms * kSpan, 0.0), right_(knots, Eigen::Vector3d::Zero()) {}

  void Add(const Difference& difference, double weight) {
    const ImageJacobian jacobian = difference.jacobian.cast<double>();
    const Eigen::Matrix3d square = weight * jacobian.transpose() * jacobian;
    const Eigen::Vector3d right = weight * jacobian.transpose() * difference.value.cast<double>();
    std::array<double, 2 * kSpan> weights{};
    std::ranges::copy(difference.weights, weights.begin());
    for (int i = 0; i < kSpan; ++i) {
      // Beyond the last knot there are no weights.
      if (weights[i] != 0.0) right_[difference.first + i] += weights[i] * right;
    }
    std::array<double, kTerms> block;
    for (int term = 0; term < kTerms; ++term) block[term] = square(kRows[term], kColumns[term]);
    AddProducts(weights, block, terms_.data() + difference.first * kTerms * kSpan);
  }

  std::vector<Eigen::Vector3d> Solve() const {
    const auto knots = static_cast<int>(right_.size());
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right(3 * knots);
    for (int i = 0; i < knots; ++i) {
      right.segment<3>(3 * i) = right_[i];
      for (int d = 0; d < kSpan && i + d < knots; ++d) {
        for (int term = 0; term < kTerms; ++term) {
          const int row = kRows[term];
          const int column = kColumns[term];
          const double value = terms_[(i * kTerms + term) * kSpan + d];
          const double prior = d == 0 && row == column ? 1.0 / (kShakePx * kShakePx) : 0.0;
          entries.emplace_back(3 * (i + d) + column, 3 * i + row, value + prior);
          if (d && row != column) entries.emplace_back(3 * (i + d) + row, 3 * i + column, value);
        }
      }
    }
    Eigen::SparseMatrix<double> lower(3 * knots, 3 * knots);
    lower.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(lower);
    std::vector<Eigen::Vector3d> coefficients(right_.size(), Eigen::Vector3d::Zero());
    if (factors.info() != Eigen::Success) return coefficients;
    const Eigen::VectorXd solution = factors.solve(right);
    for (int i = 0; i < knots; ++i) coefficients[i] = solution.segment<3>(3 * i);
    return coefficients;
  }

 private:
  // Of the blocks of each knot with itself, with the next one, ...: first terms, then knots.
  std::vector<double> terms_;
  std::vector<Eigen::Vector3d> right_;
};

/// The shake during one stretch of time.
class ShakeEstimator {
 public:
  /// `tracks`: the observations of the stretch, in order of time.
  ShakeEstimator(const JacobianTable& lens, std::span<const events::TrackObservation> tracks,
                 std::span<const ObservedWindow> windows)
      : lens_(lens), tracks_(tracks), windows_(windows) {
    const auto second = std::ranges::upper_bound(tracks_, tracks_.front().t, {}, &events::TrackObservation::t);
    if (second != tracks_.end()) {
      const double frame_s = ToSeconds(second->t - tracks_.front().t);
      stride_ = static_cast<std::size_t>(std::clamp(kKnotS / frame_s + 0.5, 1.0, 1000.0));
    }
    const auto knots = static_cast<std::size_t>(InKnots(tracks_.back().t)) + 2 * kWeights;
    coefficients_.assign(knots, Eigen::Vector3d::Zero());
    Collect();
    for (int round = 0; round < kRounds; ++round) Refine();
  }

  /// Where observation `index` was at its very stamp.
  Eigen::Vector2d Restored(std::size_t index) const {
    const Sample sample = MakeSample(index);
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    for (int k = 0; k < kWeights; ++k) {
      shift += (sample.instant[k] - sample.window[k]) * coefficients_[sample.first + k];
    }
    return sample.position + sample.jacobian * shift;
  }

 private:
  double InKnots(TimeNs t) const { return ToSeconds(t - tracks_.front().t) / kKnotS; }

  /// Px for a rotation of one px at the image's centre.
  ImageJacobian JacobianAt(const events::TrackObservation& o) const {
    return lens_.Lookup({o.x, o.y}).J_pixel_rotation / lens_.focal_px();
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
    const double longest = kLongestHalfWindow * kKnotS;
    const bool is_instant = sample.half_s <= kInstant * kKnotS;
    const double half = std::min(std::hypot(sample.half_s, kSmearS), longest) / kKnotS;
    const double reach = kSlopeReach * std::min(sample.half_s, longest) / kKnotS;
    const int first = static_cast<int>(std::floor(u)) - kWeights / 2 + 1;
    for (int k = 0; k < kWeights; ++k) {
      const double away = u - (first + k);
      sample.instant[k] = Spline(away);
      sample.window[k] = sample.instant[k];
      if (is_instant) continue;
      sample.window[k] = (SplineIntegral(away + half) - SplineIntegral(away - half)) / (2.0 * half);
      sample.slope[k] = (Spline(away + reach) - Spline(away - reach)) / (2.0 * reach * kKnotS);
    }
    sample.first = first + kWeights;  // the knots begin so far before the first stamp
    return sample;
  }

  /// The differences along all tracks.
  void Collect() {
    std::vector<std::size_t> order(tracks_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return tracks_[i].id; });
    std::vector<Sample> samples;  // of a track
    for (std::size_t i = 0; i < order.size(); ++i) {
      samples.push_back(MakeSample(order[i]));
      if (i + 1 < order.size() && tracks_[order[i + 1]].id == tracks_[order[i]].id) continue;
      CollectFrom(samples);
      samples.clear();
    }
  }

  void CollectFrom(std::span<const Sample> track) {
    for (std::size_t i = 0; i + 2 * stride_ < track.size(); ++i) {
      // Flows count as the way moved within half a window, and so err like positions.
      const double half_s = track[i + stride_].half_s;
      if (half_s > 0.0) AddDifference(track.subspan(i), half_s, kFlowDifference, &Sample::flow, &Sample::slope);
      if (i + 4 * stride_ >= track.size()) continue;
      AddDifference(track.subspan(i), 1.0, kPositionDifference, &Sample::position, &Sample::window);
    }
  }

  template <std::size_t kSize>
  void AddDifference(std::span<const Sample> samples, double unit, const std::array<double, kSize>& factors,
                     Eigen::Vector2d Sample::*value, std::array<double, kWeights> Sample::*weights) {
    const Sample& first = samples.front();
    const double duration = samples[(kSize - 1) * stride_].t_knots - first.t_knots;
    if (duration > (kSize - 1) * kLongestStep) return;
    Difference difference{.jacobian = samples[kSize / 2 * stride_].jacobian.cast<float>(), .first = first.first};
    for (std::size_t d = 0; d < kSize; ++d) {
      const Sample& sample = samples[d * stride_];
      const double factor = unit * factors[d];
      difference.value += (factor * sample.*value).template cast<float>();
      float* const at = difference.weights.data() + (sample.first - first.first);
      for (int k = 0; k < kWeights; ++k) at[k] += static_cast<float>(factor * (sample.*weights)[k]);
    }
    differences_.push_back(difference);
  }

  void Refine() {
    ShakeEquations equations(coefficients_.size());
    for (const Difference& difference : differences_) {
      Eigen::Vector3d shake = Eigen::Vector3d::Zero();
      for (int k = 0; k < kSpan; ++k) {
        if (difference.weights[k] != 0.0f) shake += difference.weights[k] * coefficients_[difference.first + k];
      }
      const Eigen::Vector2f left = difference.value - difference.jacobian * shake.cast<float>();
      equations.Add(difference, 1.0 / (1.0 + left.squaredNorm() / (kUsualDifferencePx * kUsualDifferencePx)));
    }
    coefficients_ = equations.Solve();
  }

  const JacobianTable& lens_;
  std::span<const events::TrackObservation> tracks_;
  std::span<const ObservedWindow> windows_;
  std::size_t stride_ = 1;  // frames from one knot to the next
  std::vector<Difference> differences_;
  std::vector<Eigen::Vector3d> coefficients_;
};

}  // namespace

void RestoreShake(const geometry::Camera& camera, const JacobianTable& lens, std::span<const events::TrackObservation> seen,
                  std::span<const ObservedWindow> windows, std::size_t first,
                  std::span<events::TrackObservation> restored) {
  if (restored.empty()) return;
  if (std::ranges::all_of(windows, [](const ObservedWindow& window) { return window.half_s == 0.0f; })) return;
  const ShakeEstimator estimator(lens, seen, windows);
  for (std::size_t i = 0; i < restored.size(); ++i) {
    const Eigen::Vector2d position = estimator.Restored(first + i);
    if (!camera.Contains(position)) continue;
    restored[i].x = position.x();
    restored[i].y = position.y();
  }
}

}  // namespace evo::tracking
