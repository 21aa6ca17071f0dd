#include "evo/evaluation/scale_drift.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evo::evaluation {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Mean and squared deviations of points that come and go (B. P. Welford, Technometrics 1962): exact enough far from
/// the origin, where sums of squares are not.
class Spread {
 public:
  void Add(const Eigen::Vector3d& point) {
    const Eigen::Vector3d before = point - mean_;
    mean_ += before / ++count_;
    squares_ += before.dot(point - mean_);
  }

  /// One point or more must stay.
  void Remove(const Eigen::Vector3d& point) {
    const Eigen::Vector3d before = point - mean_;
    mean_ -= before / --count_;
    squares_ = std::max(0.0, squares_ - before.dot(point - mean_));
  }

  double squares() const { return squares_; }

 private:
  double count_ = 0.0;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
  double squares_ = 0.0;
};

/// The poses [first, last) around a pose, moved along the path.
class Window {
 public:
  explicit Window(const MatchedPath& path) : path_(path) {}

  /// Both ends only ever move forward, and `first` < `last`.
  void MoveTo(std::size_t first, std::size_t last) {
    if (first >= last_) {
      truth_ = estimate_ = {};
      first_ = last_ = first;
    }
    for (; last_ < last; ++last_) {
      truth_.Add(path_.truth[last_]);
      estimate_.Add(path_.estimate[last_]);
    }
    for (; first_ < first; ++first_) {
      truth_.Remove(path_.truth[first_]);
      estimate_.Remove(path_.estimate[first_]);
    }
  }

  std::size_t first() const { return first_; }
  std::size_t last() const { return last_; }
  double length() const { return path_.distance[last_ - 1] - path_.distance[first_]; }
  double ratio() const {
    return estimate_.squares() > 0.0 ? std::sqrt(truth_.squares() / estimate_.squares()) : kUnknown;
  }

 private:
  const MatchedPath& path_;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  Spread truth_;
  Spread estimate_;
};

/// For each pose the index behind the last one that no gap parts from it.
std::vector<std::size_t> FindPieceEnds(const std::vector<TimeNs>& t, TimeNs longest_gap) {
  std::vector<std::size_t> ends(t.size(), t.size());
  for (std::size_t i = t.size(); i-- > 1;) {
    ends[i - 1] = t[i] - t[i - 1] > longest_gap ? i : ends[i];
  }
  return ends;
}

}  // namespace

std::vector<ScaleSample> ComputeLocalScale(const MatchedPath& path, TimeNs from, TimeNs longest_gap,
                                           const LocalScaleOptions& options) {
  std::vector<ScaleSample> samples;
  if (path.size() == 0) return samples;
  const auto& distance = path.distance;
  const auto piece_ends = FindPieceEnds(path.t, longest_gap);
  const double stretch = std::min(options.stretch_m, distance.back() / 5.0);
  Window window(path);
  std::size_t piece = 0;  // first pose of the present one
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0 && piece_ends[i] != piece_ends[i - 1]) piece = i;
    std::size_t first = std::max(window.first(), piece);
    std::size_t last = std::max(window.last(), i);
    while (distance[first] < distance[i] - 0.5 * stretch) ++first;
    while (last < piece_ends[i] && distance[last] <= distance[i] + 0.5 * stretch) ++last;
    window.MoveTo(first, last);
    const bool enough = stretch > 0.0 && window.length() >= 0.25 * stretch;
    samples.push_back({ToSeconds(path.t[i] - from), distance[i], enough ? window.ratio() : kUnknown});
  }
  return samples;
}

}  // namespace evo::evaluation
