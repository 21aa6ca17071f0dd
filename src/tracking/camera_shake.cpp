#include "evo/tracking/camera_shake.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "evo/tracking/lens_grid.hpp"

namespace evo {

namespace {

constexpr double kKnotS = 0.02;             // of the spline: follows a shake of up to some 20 Hz
constexpr double kLongestHalfWindow = 4.0;  // knots; longer windows are treated like this
constexpr int kWeights = 12;                // knots that such a window depends on
constexpr double kInstant = 1e-3;           // knots; a shorter half window is none
constexpr std::array<double, 5> kDifference{1.0, -4.0, 6.0, -4.0, 1.0};
constexpr int kSpan = 4 + kWeights + 1;     // knots that a difference depends on
constexpr double kUsualDifferencePx = 1.0;  // beyond this a difference is taken for an outlier
constexpr double kShakePx = 1.0;            // usual size of the shake
constexpr int kRounds = 3;
// Stretches that are solved each by itself, with a margin on either side.
constexpr TimeNs kStretch = 5 * kNsPerSecond;
constexpr TimeNs kMargin = kNsPerSecond / 2;

using ImageJacobian = Eigen::Matrix<double, 2, 3>;

/// The integral of the cubic B-spline with knots at whole numbers, from minus infinity to `u`.
double SplineIntegral(double u) {
  if (u > 0.0) return 1.0 - SplineIntegral(-u);
  if (u <= -2.0) return 0.0;
  if (u <= -1.0) return std::pow(2.0 + u, 4) / 24.0;
  return 0.5 + u * (2.0 / 3.0 - u * u * (1.0 / 3.0 + u / 8.0));
}

double Spline(double u) {
  const double a = std::abs(u);
  if (a >= 2.0) return 0.0;
  return a >= 1.0 ? std::pow(2.0 - a, 3) / 6.0 : 2.0 / 3.0 - a * a * (1.0 - 0.5 * a);
}

/// An observation, and how it depends on the coefficients of the knots from `first` on.
struct Sample {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  ImageJacobian jacobian = ImageJacobian::Zero();
  int first = 0;
  std::array<double, kWeights> instant{};  ///< the spline at the stamp
  std::array<double, kWeights> window{};   ///< its mean over the window
};

/// The normal equations of the spline: a band of 3 x 3 blocks.
class ShakeEquations {
 public:
  explicit ShakeEquations(std::size_t knots)
      : blocks_(knots * kSpan, Eigen::Matrix3d::Zero()), right_(knots, Eigen::Vector3d::Zero()) {}

  /// `rows` [k] is the derivative of the residual with respect to the coefficients of knot `first` + k.
  void Add(int first, const std::array<ImageJacobian, kSpan>& rows, const Eigen::Vector2d& residual, double weight) {
    for (int i = 0; i < kSpan; ++i) {
      const Eigen::Matrix<double, 3, 2> left = weight * rows[i].transpose();
      if (left.isZero(0.0)) continue;
      right_[first + i] += left * residual;
      for (int k = i; k < kSpan; ++k) Block(first + i, k - i) += left * rows[k];
    }
  }

  std::vector<Eigen::Vector3d> Solve() const {
    const auto knots = static_cast<int>(right_.size());
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right(3 * knots);
    for (int i = 0; i < knots; ++i) {
      right.segment<3>(3 * i) = right_[i];
      for (int d = 0; d < kSpan && i + d < knots; ++d) {
        const Eigen::Matrix3d& block = blocks_[i * kSpan + d];
        for (int r = 0; r < 3; ++r) {
          for (int c = d ? 0 : r; c < 3; ++c) {
            const double prior = d == 0 && r == c ? 1.0 / (kShakePx * kShakePx) : 0.0;
            entries.emplace_back(3 * (i + d) + c, 3 * i + r, block(r, c) + prior);
          }
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
  Eigen::Matrix3d& Block(int knot, int distance) { return blocks_[knot * kSpan + distance]; }

  std::vector<Eigen::Matrix3d> blocks_;
  std::vector<Eigen::Vector3d> right_;
};

/// The shake during one stretch of time.
class ShakeEstimator {
 public:
  /// `tracks`: the observations of the stretch, in order of time.
  ShakeEstimator(const LensGrid& lens, std::span<const TrackObservation> tracks, std::span<const float> half_windows_s)
      : lens_(lens), tracks_(tracks), half_windows_s_(half_windows_s), order_(tracks.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::ranges::stable_sort(order_, {}, [&](std::size_t i) { return tracks_[i].id; });
    for (std::size_t i = 0; i < order_.size(); ++i) {
      if (i == 0 || tracks_[order_[i]].id != tracks_[order_[i - 1]].id) starts_.push_back(i);
    }
    const auto second = std::ranges::upper_bound(tracks_, tracks_.front().t, {}, &TrackObservation::t);
    if (second != tracks_.end()) {
      const double frame_s = ToSeconds(second->t - tracks_.front().t);
      stride_ = static_cast<std::size_t>(std::clamp(kKnotS / frame_s + 0.5, 1.0, 1000.0));
    }
    const auto knots = static_cast<std::size_t>(InKnots(tracks_.back().t)) + 2 * kWeights;
    coefficients_.assign(knots, Eigen::Vector3d::Zero());
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
  ImageJacobian JacobianAt(const TrackObservation& o) const {
    return lens_.At({o.x, o.y}).by_rotation / lens_.focal_px();
  }

  Sample MakeSample(std::size_t index) const {
    const TrackObservation& observation = tracks_[index];
    Sample sample{{observation.x, observation.y}, JacobianAt(observation), 0, {}, {}};
    const double u = InKnots(observation.t);
    const double half = std::min(half_windows_s_[index] / kKnotS, kLongestHalfWindow);
    const int first = static_cast<int>(std::floor(u)) - kWeights / 2 + 1;
    for (int k = 0; k < kWeights; ++k) {
      const double away = u - (first + k);
      sample.instant[k] = Spline(away);
      sample.window[k] = half > kInstant ? (SplineIntegral(away + half) - SplineIntegral(away - half)) / (2.0 * half)
                                         : sample.instant[k];
    }
    sample.first = first + kWeights;  // the knots begin so far before the first stamp
    return sample;
  }

  void Refine() {
    ShakeEquations equations(coefficients_.size());
    std::vector<Sample> samples;
    for (std::size_t track = 0; track < starts_.size(); ++track) {
      samples.clear();
      const std::size_t end = track + 1 < starts_.size() ? starts_[track + 1] : order_.size();
      for (std::size_t i = starts_[track]; i < end; ++i) samples.push_back(MakeSample(order_[i]));
      for (std::size_t i = 0; i + 4 * stride_ < samples.size(); ++i) {
        AddDifference({&samples[i], &samples[i + stride_], &samples[i + 2 * stride_], &samples[i + 3 * stride_],
                       &samples[i + 4 * stride_]},
                      &equations);
      }
    }
    coefficients_ = equations.Solve();
  }

  void AddDifference(const std::array<const Sample*, 5>& samples, ShakeEquations* equations) const {
    const int first = samples.front()->first;
    if (samples.back()->first - first > kSpan - kWeights) return;  // frames so far apart tell nothing of shakes
    std::array<ImageJacobian, kSpan> rows;
    rows.fill(ImageJacobian::Zero());
    Eigen::Vector2d difference = Eigen::Vector2d::Zero();
    for (std::size_t d = 0; d < kDifference.size(); ++d) {
      difference += kDifference[d] * samples[d]->position;
      for (int k = 0; k < kWeights; ++k) {
        rows[samples[d]->first - first + k] += kDifference[d] * samples[d]->window[k] * samples[d]->jacobian;
      }
    }
    Eigen::Vector2d left = difference;
    for (int k = 0; k < kSpan; ++k) left -= rows[k] * coefficients_[first + k];
    const double weight = 1.0 / (1.0 + left.squaredNorm() / (kUsualDifferencePx * kUsualDifferencePx));
    equations->Add(first, rows, difference, weight);
  }

  const LensGrid& lens_;
  std::span<const TrackObservation> tracks_;
  std::span<const float> half_windows_s_;
  std::vector<std::size_t> order_;   // of the observations, track by track
  std::vector<std::size_t> starts_;  // of the tracks in it
  std::size_t stride_ = 1;           // frames from one knot to the next
  std::vector<Eigen::Vector3d> coefficients_;
};

}  // namespace

void RestoreShake(const Camera& camera, std::span<const float> half_windows_s, ThreadPool* pool, Tracks* tracks) {
  if (std::ranges::all_of(half_windows_s, [](float half) { return half == 0.0f; })) return;
  const LensGrid lens(camera);
  const Tracks smoothed = *tracks;
  const auto index_of = [&](TimeNs t) {
    return static_cast<std::size_t>(std::ranges::lower_bound(smoothed, t, {}, &TrackObservation::t) - smoothed.begin());
  };
  const TimeNs start = smoothed.front().t;
  const auto stretches = static_cast<std::size_t>((smoothed.back().t - start) / kStretch + 1);
  pool->ForEach(stretches, [&](std::size_t stretch) {
    const TimeNs from = start + static_cast<TimeNs>(stretch) * kStretch;
    const std::size_t first = index_of(from - kMargin);
    const std::size_t begin = index_of(from);
    const std::size_t end = index_of(from + kStretch);
    if (begin == end) return;
    const std::size_t count = index_of(from + kStretch + kMargin) - first;
    const ShakeEstimator estimator(lens, std::span(smoothed).subspan(first, count),
                                   half_windows_s.subspan(first, count));
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector2d restored = estimator.Restored(i - first);
      if (!camera.Contains(restored)) continue;
      (*tracks)[i].x = restored.x();
      (*tracks)[i].y = restored.y();
    }
  });
}

}  // namespace evo
