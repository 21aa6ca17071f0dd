#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/events/event_history.hpp"
#include "tracking/detection/feature_initializer.hpp"
#include "tracking/feature_aligner.hpp"
#include "tracking/gating/outlier_classifier.hpp"
#include "tracking/motion/ego_motion.hpp"
#include "tracking/motion/epipolar_filter.hpp"
#include "tracking/motion/rotation_correction.hpp"
#include "tracking/sensor_area.hpp"
#include "tracking/tracked_feature.hpp"
#include "tracking/tracker.hpp"

namespace evo::tracking {

/// Tracks features by expectation maximisation on events (A. Z. Zhu, N. Atanasov, K. Daniilidis: Event-Based Feature
/// Tracking with Probabilistic Data Association, ICRA 2017). A position is that at the very stamp of the event frame,
/// however long the feature's window.
class FeatureTracker : public Tracker {
 public:
  FeatureTracker(const geometry::Camera& camera, const TrackerOptions& options, ThreadPool* pool);
  FeatureTracker(const FeatureTracker&) = delete;
  FeatureTracker& operator=(const FeatureTracker&) = delete;

  void Track(const events::EventHistory& history, TimeNs t) override;
  void EstimateMotion() override;
  void UpdateFeatures(const events::EventHistory& history) override;
  TimeNs before() const override { return FromSeconds(0.5 * options_.max_window_s); }
  TimeNs after() const override { return before(); }
  events::Tracks Observations() const override;
  std::vector<ObservedWindow> Windows() const override;
  std::vector<std::int64_t> Rejected() const override { return rejected_; }
  bool is_key_frame() const override { return is_key_frame_; }

 private:
  /// Aligns all features, expecting a rotation that the camera's motion so far does not predict.
  void AlignFeatures(const events::EventHistory& history, const RotationCorrection& correction);
  /// Aligns all features again if they share an unpredicted rotation.
  void CorrectRotation(const events::EventHistory& history);
  std::vector<PredictionResidual> PredictionResiduals() const;
  /// Rejects alignments that are much farther from their prediction than those of most features.
  void GateInnovations();
  /// The reported positions of all features, px.
  std::vector<Eigen::Vector2d> FilterPositions();
  /// Takes the alignments over into the features and removes the lost ones.
  void AdvanceFeatures(const std::vector<Eigen::Vector2d>& filtered_positions);
  void AdvanceFeature(const FeatureAlignment& alignment, TrackedFeature* feature) const;
  /// Updates the depths of all features, and from them the planes that they lie on.
  void UpdateSurfaces();
  /// Classifies the features that have become old enough.
  void RejectOutliers();

  TrackerOptions options_;
  SensorArea area_;
  ThreadPool* pool_;
  EgoMotion ego_motion_;
  FeatureAligner aligner_;
  FeatureInitializer initializer_;
  EpipolarFilter epipolar_filter_;
  OutlierClassifier outlier_classifier_;
  std::vector<TrackedFeature> features_;
  std::vector<FeatureAlignment> alignments_;  // of the features, in their order; surplus ones are kept for their memory
  std::optional<TimeNs> t_;                   // stamp of the frame
  double step_s_ = 0.0;                       // since the frame before; 0 in the first frame
  std::vector<std::int64_t> rejected_;        // in the frame
  bool is_key_frame_ = false;
};

}  // namespace evo::tracking
