#include "tracking/feature_aligner.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tracking/event_window.hpp"

namespace evo::tracking {

namespace {

constexpr int kCoarseIterations = 6;   // bring a feature within the reach of the fine association
constexpr int kEstablishedFrames = 5;  // a younger feature must show itself in every frame
constexpr double kFlowGain = 0.28;     // typical ratio of the predicted flow's error that a window corrects

}  // namespace

Eigen::Vector2d FeatureAlignment::UnpredictedFlow() const { return (aligned.flow - predicted.flow) / kFlowGain; }

Eigen::Matrix2d FeatureAlignment::UnpredictedShapeRate(double step_s) const {
  return (aligned.linear * predicted.linear.inverse() - Eigen::Matrix2d::Identity()) / step_s;
}

void FeatureAligner::Align(const events::EventHistory& history, TimeNs t, double step_s,
                           const RotationCorrection& correction, const TrackedFeature& feature,
                           FeatureAlignment* alignment) const {
  using State = FeatureAlignment::State;
  alignment->state = State::kLost;
  Predict(feature, step_s, correction, alignment);
  if (!GatherEvents(history, t, feature, alignment)) {
    if (MayRest(feature, *alignment)) alignment->state = State::kResting;
    return;
  }
  const EventHistogram& histogram = PredictPolarities(feature, step_s, alignment);
  if (Fit(feature, histogram, Association::kFine, alignment) ||
      Fit(feature, histogram, Association::kCoarseToFine, alignment)) {
    alignment->state = State::kAligned;
  } else if (MayRest(feature, *alignment)) {
    alignment->state = State::kResting;
  }
}

void FeatureAligner::Predict(const TrackedFeature& feature, double step_s, const RotationCorrection& correction,
                             FeatureAlignment* alignment) const {
  const FeatureState& state = feature.state;
  const PatchFlow patch = ego_motion_.PredictPatchFlow(state.flow_sample(), feature.surface.gradient());
  const Eigen::Vector2d flow = ego_motion_.ProjectToEpipolarLine(state.flow_sample());
  PatchMotion& motion = alignment->predicted;
  motion = PatchMotion();
  motion.flow = flow + step_s * patch.acceleration;
  motion.linear = (Eigen::Matrix2d::Identity() + step_s * patch.linear_rate) * state.shape.linear;
  motion.perspective = state.shape.perspective - step_s * state.shape.linear.transpose() * patch.quadratic_rate;
  motion.linear_rate = patch.linear_rate;
  motion.quadratic_rate = patch.quadratic_rate;
  alignment->predicted_position = state.position + 0.5 * step_s * (flow + motion.flow);

  alignment->J_pixel_rotation = ego_motion_.jacobians().Lookup(alignment->predicted_position).J_pixel_rotation;
  alignment->predicted_position += alignment->J_pixel_rotation * correction.rotation;
  motion.flow += alignment->J_pixel_rotation * correction.angular_velocity;
}

const EventHistogram& FeatureAligner::PredictPolarities(const TrackedFeature& feature, double step_s,
                                                        FeatureAlignment* alignment) const {
  const EventHistogram& histogram = feature.event_template.histogram();
  if (!options_.predict_polarity) return histogram;
  const double flow_sigma_px_s =
      ego_motion_.jacobians().focal_px() * ego_motion_.typical_angular_acceleration() * step_s;
  feature.event_template.FindFlips(VelocityInTemplate(alignment->predicted), flow_sigma_px_s, &alignment->flips);
  if (!alignment->flips.any()) return histogram;
  thread_local std::optional<EventHistogram> flipped;
  flipped = histogram;
  alignment->flips.Apply(&*flipped);
  return *flipped;
}

bool FeatureAligner::GatherEvents(const events::EventHistory& history, TimeNs t, const TrackedFeature& feature,
                                  FeatureAlignment* alignment) const {
  const Eigen::Vector2d& position = alignment->predicted_position;
  const Eigen::Vector2d& flow = alignment->predicted.flow;
  const auto has_events = [&](int min_events) {
    history.Gather({t, position.x(), position.y(), flow.x(), flow.y(), static_cast<double>(options_.patch_radius_px),
                    alignment->half_window},
                   &alignment->events);
    return alignment->events.size() >= static_cast<std::size_t>(min_events);
  };
  alignment->half_window = FeatureHalfWindow(flow, ego_motion_, options_);
  if (!has_events(options_.min_events)) {
    alignment->half_window = DoubledHalfWindow(alignment->half_window, options_);
    const bool is_established = feature.frames >= kEstablishedFrames;
    if (!has_events(is_established ? options_.min_events_established : options_.min_events)) return false;
  }
  alignment->events.Subsample(static_cast<std::size_t>(options_.max_events));
  return true;
}

bool FeatureAligner::Fit(const TrackedFeature& feature, const EventHistogram& histogram, Association association,
                         FeatureAlignment* alignment) const {
  const bool has_flips = alignment->flips.any();
  const auto radius = static_cast<double>(options_.patch_radius_px);
  PatchMotion& motion = alignment->aligned;
  motion = alignment->predicted;
  thread_local AssociationTable table;
  const auto self_bias = [&] { return table.ComputeSelfBias(histogram, motion.linear, radius); };
  const auto align = [&](const SelfBias& bias, int iterations, bool with_linear) {
    return AlignToTemplate(
        alignment->events, table, histogram.planes(),
        {iterations, radius, ToSeconds(alignment->half_window), options_.flow_prior, options_.affine_prior, bias},
        with_linear, &motion);
  };
  if (association == Association::kCoarseToFine) {
    table.Build(histogram, options_.coarse_sigma_px, options_.outlier_density_ratio);
    align(self_bias(), kCoarseIterations, false);
  }
  table.Build(histogram, options_.fine_sigma_px, options_.outlier_density_ratio);
  const auto& known_bias = feature.event_template.self_bias();
  const SelfBias bias = known_bias && !has_flips ? *known_bias : self_bias();
  alignment->self_bias.reset();
  if (!has_flips) alignment->self_bias = bias;
  const AlignmentQuality quality = align(bias, options_.iterations, true);
  alignment->log_likelihood_ratio = MeanLogLikelihoodRatio(alignment->events, table, histogram.planes(), motion);
  alignment->outlier_ratio = 1.0 - quality.inlier_ratio;
  return alignment->log_likelihood_ratio >= options_.min_log_likelihood_ratio && IsPlausible(quality, feature, motion);
}

bool FeatureAligner::IsPlausible(const AlignmentQuality& quality, const TrackedFeature& feature,
                                 const PatchMotion& aligned) const {
  const double scale = feature.event_template.scale() * std::sqrt(std::abs(aligned.linear.determinant()));
  return quality.inlier_ratio >= options_.min_inlier_ratio && quality.residual_px <= options_.max_residual_px &&
         aligned.offset.norm() <= options_.max_prediction_error_px && scale < options_.max_scale &&
         scale > 1.0 / options_.max_scale;
}

bool FeatureAligner::MayRest(const TrackedFeature& feature, const FeatureAlignment& alignment) const {
  return feature.frames >= kEstablishedFrames && alignment.predicted.flow.norm() <= options_.resting_flow_px_s;
}

}  // namespace evo::tracking
