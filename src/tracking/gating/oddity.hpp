#pragma once

#include <Eigen/Core>
#include <array>
#include <deque>
#include <vector>

namespace evo::tracking {

/// What a feature does that a small plane at rest does not: its patch lands beside where it is predicted, changes its
/// shape, and does not explain the events. Each alone may be noise, but where a pattern slides along a line or hangs on
/// the edges of two things at different depths they come together, and persist.
struct Oddity {
  /// Across the line along which the camera's translation moves a point, px; the norm of the rate at which the shape
  /// changes beyond the predicted, over the flow, 1/px; the share of stray events. Of means over the feature's life.
  std::array<double, 3> sizes{};
};

/// Means over the first frames of a feature.
class OddityMeans {
 public:
  /// `offset`: from the predicted to the aligned position, px; `rate`: see Oddity.
  void Add(const Eigen::Vector2d& offset, const Eigen::Matrix2d& rate, double stray_share);
  int frames() const { return frames_; }
  /// `away`: along that line, of any length.
  Oddity Of(const Eigen::Vector2d& away) const;

 private:
  int frames_ = 0;
  Eigen::Vector2d offset_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d rate_ = Eigen::Matrix2d::Zero();
  double stray_share_ = 0.0;
};

/// Compares features with the last ones: the oddest are those that are unusual in all respects together, by the sum of
/// log(1 + size / usual size) with the medians for what is usual.
class OddityJudge {
 public:
  explicit OddityJudge(double odd_share) : odd_share_(odd_share) {}

  /// Whether each of `young` belongs to the oddest `odd_share` of the last features, these included. None does while
  /// there are few to compare with.
  std::vector<bool> AreOdd(const std::vector<Oddity>& young);

 private:
  double odd_share_;
  std::deque<Oddity> last_;
};

}  // namespace evo::tracking
