#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/events/event_history.hpp"
#include "tracking/detection/flow_field.hpp"
#include "tracking/gating/oddity.hpp"
#include "tracking/motion/depth_samples.hpp"
#include "tracking/motion/ego_motion.hpp"
#include "tracking/motion/epipolar_filter.hpp"
#include "tracking/motion/rotation_correction.hpp"
#include "tracking/patch/event_histogram.hpp"
#include "tracking/patch/em_alignment.hpp"
#include "tracking/tracker.hpp"

namespace evo::tracking {

/// A live feature: a template of events and where it is now.
struct TrackedFeature {
  std::int64_t id = 0;
  Eigen::Vector2d position;                               ///< px, at the stamp of the last event frame
  Eigen::Vector2d filtered;                               ///< the same, see EpipolarFilter: what is reported
  Eigen::Vector2d flow;                                   ///< px/s
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();   ///< template to sensor
  Eigen::Vector2d perspective = Eigen::Vector2d::Zero();  ///< of the same, see PatchMotion
  double inverse_depth = 0.0;                             ///< mean over the last frames, see EgoMotion
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();        ///< of its plane, see EgoMotion::At
  double scale = 1.0;                                     ///< of the patch against its first window
  EventHistogram events;                                      ///< the template
  std::optional<SelfBias> self_bias = {};               ///< of the template since it learnt, see AssociationTable
  int windows = 1;                                        ///< that the template has learnt from
  double unlearnt_s = 0.0;                                ///< time since the last of them
  double information = 0.0;                               ///< see AssociationTable, in the worst direction, at birth
  int frames = 1;                                         ///< lifetime so far
  OddityMeans oddity = {};                                ///< over its life so far
  bool judged = false;                                    ///< whether it is odd
  bool withdrawn = false;                                 ///< found to be odd: followed, but no longer reported
  TimeNs half_window = 0;                                 ///< of the events behind the position
  Eigen::Vector2d told_flow = Eigen::Vector2d::Zero();    ///< px/s, what those events alone tell
};

/// Where the events of a frame put a feature.
struct FeatureAlignment {
  enum class State {
    kFound,
    kResting,  ///< hardly moves and makes no events: it stays where it is predicted to be
    kLost,
  };
  State state = State::kLost;
  Eigen::Vector2d position;                 ///< predicted, px: `start` and `motion` are relative to it
  Eigen::Matrix<double, 2, 3> J_pixel_rotation;  ///< there, see PixelJacobians
  PatchMotion start;                        ///< predicted
  PatchMotion motion;                       ///< aligned
  TimeNs half_window = 0;
  events::LocalEvents events;
  double stray_share = 0.0;  ///< of the events, see AlignmentQuality
  SelfBias self_bias;      ///< of the template, see AssociationTable

  /// Where the feature is now, px.
  Eigen::Vector2d Landed() const { return state == State::kFound ? position + motion.offset : position; }
};

/// Tracks features by expectation maximisation. The positions reported are those at the very instant of the event
/// frame, whatever the window of each feature.
class FeatureTracker : public Tracker {
 public:
  FeatureTracker(const geometry::Camera& camera, const TrackerOptions& options, ThreadPool* pool);

  void Process(const events::EventHistory& history, TimeNs t, const std::function<void()>& read_ahead) override;
  TimeNs before() const override { return FromSeconds(0.5 * options_.max_window_s); }
  TimeNs after() const override { return before(); }
  events::Tracks Observations() const override;
  std::vector<ObservedWindow> Windows() const override;
  bool detected() const override { return detected_; }
  std::vector<std::int64_t> Withdrawn() const override { return withdrawn_; }

 private:
  std::vector<FlowSample> Flows() const;
  /// Half of the window for a feature with this flow.
  TimeNs HalfWindowOf(const Eigen::Vector2d& flow) const;
  void Track(const events::EventHistory& history, TimeNs t);
  /// How a feature probably lies in the sensor `step_s` after the last frame, relative to the `position` returned.
  PatchMotion Predict(const TrackedFeature& feature, double step_s, Eigen::Vector2d* position) const;
  void Align(const events::EventHistory& history, TimeNs t, const RotationCorrection& jolt, const TrackedFeature& feature,
             FeatureAlignment* alignment) const;
  void AlignAll(const events::EventHistory& history, TimeNs t, const RotationCorrection& jolt);
  /// Where all features turned unexpectedly, aligns them again, expecting that.
  void FollowJolt(const events::EventHistory& history, TimeNs t);
  /// Where all features are reported, after the alignment and before they advance.
  std::vector<Eigen::Vector2d> FilteredPositions(double step_s);
  std::vector<PredictionResidual> PredictionResiduals() const;
  /// Aligns the events to the feature's template from `start`; false if they do not fit it.
  bool Fit(const TrackedFeature& feature, bool coarse_first, FeatureAlignment* alignment) const;
  bool MayRest(const FeatureAlignment& alignment, const TrackedFeature& feature) const;
  /// False if the feature is lost.
  bool Advance(const FeatureAlignment& alignment, double step_s, TrackedFeature* feature) const;
  /// Whether a place is far enough from the sensor's edge for a feature.
  bool IsInside(const Eigen::Vector2d& position) const;
  /// Of all features, and from them the slopes of the planes that they lie on.
  void LearnDepths(double step_s);
  std::vector<DepthSample> Depths() const;
  /// Of the features that have just grown old enough to be judged.
  void WithdrawOdd();
  /// `unexpected_rate`: by how much the patch changed faster than its plane's slope made expect, 1/s.
  void LearnSlope(const Eigen::Matrix2d& unexpected_rate, TrackedFeature* feature) const;
  void UpdateTemplate(const events::LocalEvents& events, const PatchMotion& motion, TrackedFeature* feature) const;

  // In feature_birth.cpp.
  void Refill(const events::EventHistory& history, TimeNs t);
  /// How much a new feature must tell of its position: of the last ones, refused ones among them, the
  /// `uninformative_ratio` tells less.
  double LeastInformation(const std::vector<TrackedFeature>& born);
  std::optional<TrackedFeature> Birth(const events::EventHistory& history, TimeNs t, const Eigen::Vector2d& position,
                                      const std::vector<DepthSample>& depths) const;
  int planes() const { return options_.use_polarity ? 2 : 1; }

  TrackerOptions options_;
  int width_;
  int height_;
  ThreadPool* pool_;
  EgoMotion ego_motion_;
  EpipolarFilter epipolar_filter_;
  FlowField flow_field_;
  RefillPolicy refill_;
  OddityJudge oddity_judge_;
  std::vector<std::int64_t> withdrawn_;  // in the last frame
  std::deque<double> informations_;      // of the last features at birth, the refused ones among them
  std::vector<TrackedFeature> features_;
  std::vector<FeatureAlignment> alignments_;  // of the features, in their order; some more are kept for their memory
  std::int64_t next_id_ = 0;
  std::optional<TimeNs> last_;
  bool detected_ = false;
};

}  // namespace evo::tracking
