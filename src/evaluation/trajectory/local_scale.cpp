#include "evaluation/trajectory/local_scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evo::evaluation {

namespace {

constexpr double kMinWindowsPerPath = 5.0;  // so that drift along a short path is visible
constexpr double kMinWindowRatio = 0.25;    // of a full window; noise dominates in a shorter one
constexpr double kUndetermined = std::numeric_limits<double>::quiet_NaN();

/// Sum of squared distances of a sliding set of points from their centroid (B. P. Welford, Technometrics 1962), which
/// stays accurate far from the origin, where sums of squares do not.
class RunningScatter {
 public:
  void Add(const Eigen::Vector3d& point) {
    const Eigen::Vector3d offset = point - mean_;
    mean_ += offset / ++count_;
    sum_ += offset.dot(point - mean_);
  }

  /// At least one point must remain.
  void Remove(const Eigen::Vector3d& point) {
    const Eigen::Vector3d offset = point - mean_;
    mean_ -= offset / --count_;
    sum_ = std::max(0.0, sum_ - offset.dot(point - mean_));
  }

  double sum_of_squares() const { return sum_; }

 private:
  double count_ = 0.0;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
  double sum_ = 0.0;
};

/// The poses [first, last), a window that slides along the trajectory.
class Window {
 public:
  explicit Window(const MatchedTrajectory& trajectory) : trajectory_(trajectory) {}

  /// Both ends only move forward; `first` < `last`.
  void MoveTo(std::size_t first, std::size_t last) {
    if (first >= last_) {
      truth_ = estimate_ = {};
      first_ = last_ = first;
    }
    for (; last_ < last; ++last_) {
      truth_.Add(trajectory_.truth[last_]);
      estimate_.Add(trajectory_.estimate[last_]);
    }
    for (; first_ < first; ++first_) {
      truth_.Remove(trajectory_.truth[first_]);
      estimate_.Remove(trajectory_.estimate[first_]);
    }
  }

  std::size_t first() const { return first_; }
  std::size_t last() const { return last_; }
  double length() const { return trajectory_.distance[last_ - 1] - trajectory_.distance[first_]; }
  double ratio() const {
    return estimate_.sum_of_squares() > 0.0 ? std::sqrt(truth_.sum_of_squares() / estimate_.sum_of_squares())
                                            : kUndetermined;
  }

 private:
  const MatchedTrajectory& trajectory_;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  RunningScatter truth_;
  RunningScatter estimate_;
};

/// For each pose the end index of its piece between gaps.
std::vector<std::size_t> FindPieceEnds(const std::vector<TimeNs>& t, TimeNs max_gap) {
  std::vector<std::size_t> ends(t.size(), t.size());
  for (std::size_t i = t.size(); i-- > 1;) {
    ends[i - 1] = t[i] - t[i - 1] > max_gap ? i : ends[i];
  }
  return ends;
}

}  // namespace

std::vector<ScaleSample> ComputeLocalScale(const MatchedTrajectory& trajectory, TimeNs from, TimeNs max_gap,
                                           double segment_m) {
  std::vector<ScaleSample> samples;
  if (trajectory.size() == 0) return samples;
  const auto& distance = trajectory.distance;
  const auto piece_ends = FindPieceEnds(trajectory.t, max_gap);
  const double window_m = std::min(segment_m, distance.back() / kMinWindowsPerPath);
  Window window(trajectory);
  std::size_t piece = 0;  // first pose of the current piece
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (i > 0 && piece_ends[i] != piece_ends[i - 1]) piece = i;
    std::size_t first = std::max(window.first(), piece);
    std::size_t last = std::max(window.last(), i);
    while (distance[first] < distance[i] - 0.5 * window_m) ++first;
    while (last < piece_ends[i] && distance[last] <= distance[i] + 0.5 * window_m) ++last;
    window.MoveTo(first, last);
    const bool determined = window_m > 0.0 && window.length() >= kMinWindowRatio * window_m;
    samples.push_back({ToSeconds(trajectory.t[i] - from), distance[i], determined ? window.ratio() : kUndetermined});
  }
  return samples;
}

}  // namespace evo::evaluation
