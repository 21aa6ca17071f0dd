#pragma once

#include <Eigen/Core>
#include <optional>

#include "evo/core/time.hpp"
#include "evo/events/event_history.hpp"
#include "evo/tracking/tracker_options.hpp"
#include "tracking/motion/ego_motion.hpp"
#include "tracking/motion/rotation_correction.hpp"
#include "tracking/patch/em_alignment.hpp"
#include "tracking/patch/polarity_flips.hpp"
#include "tracking/tracked_feature.hpp"

namespace evo::tracking {

/// The alignment of a feature to the events of a frame. Predicted and aligned motion are relative to the predicted
/// position.
struct FeatureAlignment {
  enum class State {
    kAligned,
    kResting,  ///< too slow to cause events of its own: the feature stays where it is predicted
    kLost,
  };
  State state = State::kLost;
  Eigen::Vector2d predicted_position;            ///< px
  Eigen::Matrix<double, 2, 3> J_pixel_rotation;  ///< at the predicted position, see PixelJacobians
  PatchMotion predicted;
  PatchMotion aligned;
  TimeNs half_window = 0;
  events::LocalEvents events;
  double outlier_ratio = 0.0;         ///< mean probability that an event does not belong to the template
  double log_likelihood_ratio = 0.0;  ///< of the template, see MeanLogLikelihoodRatio
  PolarityFlips flips;                ///< of the predicted motion against the template
  std::optional<SelfBias> self_bias;  ///< of the template, see AssociationTable; empty if its polarities have flipped

  bool is_aligned() const { return state == State::kAligned; }
  /// The aligned motion, or the predicted one of a resting feature.
  const PatchMotion& motion() const { return is_aligned() ? aligned : predicted; }
  /// Position of the feature in the frame, px.
  Eigen::Vector2d Position() const { return is_aligned() ? predicted_position + aligned.offset : predicted_position; }
  /// Flow that the events alone tell, minus the predicted flow, px/s.
  Eigen::Vector2d UnpredictedFlow() const;
  /// Unpredicted change of the patch's shape in `step_s`, 1/s.
  Eigen::Matrix2d UnpredictedShapeRate(double step_s) const;
};

/// Finds features in the events of a frame.
class FeatureAligner {
 public:
  FeatureAligner(const TrackerOptions& options, const EgoMotion& ego_motion)
      : options_(options), ego_motion_(ego_motion) {}

  /// Aligns a feature to the frame at `t`, `step_s` after the last one. `correction`: a rotation of the camera that its
  /// motion so far does not predict.
  void Align(const events::EventHistory& history, TimeNs t, double step_s, const RotationCorrection& correction,
             const TrackedFeature& feature, FeatureAlignment* alignment) const;
  /// Whether a feature without an alignment may keep its predicted position, since it hardly moves.
  bool MayRest(const TrackedFeature& feature, const FeatureAlignment& alignment) const;

 private:
  enum class Association {
    kFine,
    kCoarseToFine,  ///< reaches farther, for a feature whose own motion is unpredicted
  };

  void Predict(const TrackedFeature& feature, double step_s, const RotationCorrection& correction,
               FeatureAlignment* alignment) const;
  /// Gathers the events of a window that is doubled if it holds too few. False if that one does, too.
  bool GatherEvents(const events::EventHistory& history, TimeNs t, const TrackedFeature& feature,
                    FeatureAlignment* alignment) const;
  /// The template with the polarities of the predicted motion; valid until the thread's next call.
  const EventHistogram& PredictPolarities(const TrackedFeature& feature, double step_s,
                                          FeatureAlignment* alignment) const;
  /// Aligns the `histogram` of the template to the events from the predicted motion on (EM 2 of A. Z. Zhu et al.).
  /// False if the result does not explain the events.
  bool Fit(const TrackedFeature& feature, const EventHistogram& histogram, Association association,
           FeatureAlignment* alignment) const;
  bool IsPlausible(const AlignmentQuality& quality, const TrackedFeature& feature, const PatchMotion& aligned) const;

  TrackerOptions options_;
  const EgoMotion& ego_motion_;
};

}  // namespace evo::tracking
