#pragma once

#include <Eigen/Core>
#include <array>

namespace evo::tracking {

/// How little a feature behaves like a small plane at rest. Each component alone may be noise; for a pattern that
/// slides along a line, or hangs on the edges of two objects at different depths, they come together and persist.
struct OutlierScore {
  /// Means over the feature's life: the prediction error across the epipolar line, px; the norm of the unpredicted rate
  /// of the patch's shape over its flow, 1/px; the ratio of events that the template does not explain.
  std::array<double, 3> components{};
};

/// What the first frames of a feature tell of its being an outlier, and the verdict.
class OutlierEvidence {
 public:
  /// Adds one frame. `offset`: aligned minus predicted position, px; `shape_rate`: the unpredicted rate of the shape
  /// over the flow, 1/px; `outlier_ratio`: of the events.
  void Add(const Eigen::Vector2d& offset, const Eigen::Matrix2d& shape_rate, double outlier_ratio);
  /// Number of frames added.
  int frames() const { return frames_; }
  /// `epipolar_direction`: in the image, of any length.
  OutlierScore Score(const Eigen::Vector2d& epipolar_direction) const;

  /// A feature is classified once.
  void Classify(bool is_outlier) {
    is_classified_ = true;
    is_rejected_ = is_outlier;
  }
  bool is_classified() const { return is_classified_; }
  /// A rejected feature is still tracked, so that it blocks its place, but not reported.
  bool is_rejected() const { return is_rejected_; }

 private:
  int frames_ = 0;
  Eigen::Vector2d offset_ = Eigen::Vector2d::Zero();      // mean
  Eigen::Matrix2d shape_rate_ = Eigen::Matrix2d::Zero();  // mean
  double outlier_ratio_ = 0.0;                            // mean
  bool is_classified_ = false;
  bool is_rejected_ = false;
};

}  // namespace evo::tracking
