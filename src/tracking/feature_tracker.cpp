#include "tracking/feature_tracker.hpp"

#include <algorithm>
#include <utility>

#include "evo/core/median.hpp"

namespace evo::tracking {

namespace {

constexpr std::size_t kChunk = 4;            // features that a thread takes at a time: one is too short a task
constexpr double kMinRotationPx = 0.2;       // the alignment itself follows a smaller unpredicted motion
constexpr int kRotationPasses = 2;           // the first may be misled by features that took a neighbour's pattern
constexpr int kClassificationFrames = 12;    // of evidence, until which noise dominates an outlier score
constexpr double kMinComparedFlowPxS = 4.0;  // limits the change of shape over the flow of a slow feature
constexpr double kRestingFlowDecay = 0.9;    // of a feature without events, per frame
constexpr int kGradientInterval = 2;         // frames; the fit to the neighbours is costly and changes slowly

}  // namespace

FeatureTracker::FeatureTracker(const geometry::Camera& camera, const TrackerOptions& options, ThreadPool* pool)
    : options_(options),
      area_(camera.width(), camera.height(), options.border_px),
      pool_(pool),
      ego_motion_(camera),
      aligner_(options, ego_motion_),
      initializer_(camera.width(), camera.height(), options, ego_motion_, pool),
      outlier_classifier_(options.rejection_ratio) {}

void FeatureTracker::Track(const events::EventHistory& history, TimeNs t) {
  step_s_ = t_ ? ToSeconds(t - *t_) : 0.0;
  t_ = t;
  AlignFeatures(history, {});  // EM 2: E step by AssociationTable (equations 6 to 9), M step by AlignToTemplate
  if (options_.rotation_correction) CorrectRotation(history);
  GateInnovations();
  AdvanceFeatures(FilterPositions());
}

void FeatureTracker::EstimateMotion() {
  if (options_.ego_motion) ego_motion_.Update(FlowSamples(features_), step_s_);
}

void FeatureTracker::UpdateFeatures(const events::EventHistory& history) {
  rejected_.clear();
  if (ego_motion_.known()) {
    UpdateSurfaces();
    RejectOutliers();
  }
  is_key_frame_ = initializer_.IsDue(features_.size());
  if (is_key_frame_) initializer_.AddFeatures(history, *t_, &features_);  // EM 1, corners
}

events::Tracks FeatureTracker::Observations() const {
  events::Tracks observations;
  for (const auto& feature : features_) {
    if (feature.outlier_evidence.is_rejected()) continue;
    const Eigen::Vector2d& position = feature.state.filtered_position;
    observations.push_back({feature.id, *t_, position.x(), position.y()});
  }
  return observations;
}

std::vector<ObservedWindow> FeatureTracker::Windows() const {
  std::vector<ObservedWindow> windows;
  for (const auto& feature : features_) {
    if (feature.outlier_evidence.is_rejected()) continue;
    const FeatureWindow& window = feature.window;
    windows.push_back({static_cast<float>(ToSeconds(window.half)), window.measured_flow.cast<float>()});
  }
  return windows;
}

void FeatureTracker::AlignFeatures(const events::EventHistory& history, const RotationCorrection& correction) {
  if (alignments_.size() < features_.size()) alignments_.resize(features_.size());
  const auto align = [&](std::size_t i) {
    aligner_.Align(history, *t_, step_s_, correction, features_[i], &alignments_[i]);
  };
  pool_->ForEach(features_.size(), align, kChunk);
}

void FeatureTracker::CorrectRotation(const events::EventHistory& history) {
  RotationCorrection correction;
  for (int pass = 0; pass < kRotationPasses; ++pass) {
    const RotationCorrection further = EstimateRotationCorrection(PredictionResiduals());
    if (further.rms_motion_px <= kMinRotationPx) return;
    correction.rotation += further.rotation;
    correction.angular_velocity += further.angular_velocity;
    AlignFeatures(history, correction);
  }
}

void FeatureTracker::GateInnovations() {
  std::vector<double> innovations;
  for (std::size_t i = 0; i < features_.size(); ++i) {
    if (alignments_[i].is_aligned()) innovations.push_back(alignments_[i].aligned.offset.norm());
  }
  if (innovations.empty()) return;
  const double max_innovation_px = options_.min_innovation_gate_px + options_.innovation_gate * Median(innovations);
  for (std::size_t i = 0; i < features_.size(); ++i) {
    FeatureAlignment& alignment = alignments_[i];
    if (!alignment.is_aligned() || alignment.aligned.offset.norm() <= max_innovation_px) continue;
    alignment.state =
        aligner_.MayRest(features_[i], alignment) ? FeatureAlignment::State::kResting : FeatureAlignment::State::kLost;
  }
}

std::vector<PredictionResidual> FeatureTracker::PredictionResiduals() const {
  std::vector<PredictionResidual> residuals;
  for (std::size_t i = 0; i < features_.size(); ++i) {
    const FeatureAlignment& alignment = alignments_[i];
    if (!alignment.is_aligned()) continue;
    residuals.push_back({alignment.J_pixel_rotation, alignment.aligned.offset, alignment.UnpredictedFlow()});
  }
  return residuals;
}

std::vector<Eigen::Vector2d> FeatureTracker::FilterPositions() {
  std::vector<FeatureStep> steps;
  for (std::size_t i = 0; i < features_.size(); ++i) {
    const FeatureAlignment& alignment = alignments_[i];
    const Eigen::Vector2d position = alignment.Position();
    const double inverse_depth =
        alignment.is_aligned() ? ego_motion_.EstimateInverseDepth({position, alignment.aligned.flow}) : 0.0;
    steps.push_back({features_[i].state.filtered_position, position, inverse_depth});
  }
  if (options_.epipolar_filter && ego_motion_.known()) {
    return epipolar_filter_.Filter(ego_motion_.motion(), ego_motion_.jacobians(), step_s_, steps);
  }
  std::vector<Eigen::Vector2d> positions;
  for (const auto& step : steps) positions.push_back(step.measured);
  return positions;
}

void FeatureTracker::AdvanceFeatures(const std::vector<Eigen::Vector2d>& filtered_positions) {
  std::vector<char> is_alive(features_.size());
  const auto advance = [&](std::size_t i) {
    if (alignments_[i].state == FeatureAlignment::State::kLost) return;
    AdvanceFeature(alignments_[i], &features_[i]);
    features_[i].state.filtered_position = filtered_positions[i];
    is_alive[i] = area_.Contains(features_[i].state.position) &&
                          features_[i].template_evidence.IsEnough(options_.min_log_likelihood_ratio)
                      ? 1
                      : 0;
  };
  pool_->ForEach(features_.size(), advance, kChunk);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < features_.size(); ++i) {
    if (!is_alive[i]) continue;
    if (kept != i) features_[kept] = std::move(features_[i]);
    ++kept;
  }
  features_.erase(features_.begin() + static_cast<std::ptrdiff_t>(kept), features_.end());
}

void FeatureTracker::AdvanceFeature(const FeatureAlignment& alignment, TrackedFeature* feature) const {
  const PatchMotion& motion = alignment.motion();
  FeatureState& state = feature->state;
  ++feature->frames;
  state.position = alignment.Position();
  state.shape = {motion.linear, motion.perspective};
  feature->window.half = alignment.half_window;
  feature->event_template.AddTime(step_s_);
  // Fewer events than that tell nothing of a feature at rest.
  if (alignment.is_aligned() || alignment.events.size() >= static_cast<std::size_t>(options_.min_events)) {
    feature->template_evidence.Add(alignment.log_likelihood_ratio);
  }
  if (!alignment.is_aligned()) {
    state.flow = kRestingFlowDecay * motion.flow;
    feature->window.measured_flow = state.flow;
    return;
  }
  state.flow = motion.flow;
  feature->window.measured_flow = alignment.predicted.flow + alignment.UnpredictedFlow();
  const Eigen::Matrix2d shape_rate = alignment.UnpredictedShapeRate(step_s_);
  feature->outlier_evidence.Add(motion.offset, shape_rate / (motion.flow.norm() + kMinComparedFlowPxS),
                                alignment.outlier_ratio);
  feature->surface.CorrectGradient(ego_motion_.EstimateInverseDepthGradient(state.position, shape_rate),
                                   state.flow.norm());
  if (alignment.self_bias) feature->event_template.set_self_bias(*alignment.self_bias);
  feature->event_template.Learn({alignment.events, motion, alignment.half_window, alignment.flips}, options_,
                                &state.shape);
}

void FeatureTracker::UpdateSurfaces() {
  for (auto& feature : features_) {
    SurfaceEstimate& surface = feature.surface;
    surface.UpdateInverseDepth(ego_motion_.PropagateInverseDepth(surface.inverse_depth(), step_s_),
                               ego_motion_.EstimateInverseDepth(feature.state.flow_sample()), feature.frames);
  }
  const std::vector<DepthSample> depths = DepthSamples(features_);
  const auto fit_gradient = [&](std::size_t i) {
    TrackedFeature& feature = features_[i];
    if ((feature.id + feature.frames) % kGradientInterval != 0) return;
    const auto gradient = FitInverseDepthGradient(depths, depths[i]);
    if (gradient) feature.surface.SetGradient(*gradient);
  };
  pool_->ForEach(features_.size(), fit_gradient, kChunk);
}

void FeatureTracker::RejectOutliers() {
  std::vector<TrackedFeature*> young;
  std::vector<OutlierScore> scores;
  for (auto& feature : features_) {
    const OutlierEvidence& evidence = feature.outlier_evidence;
    if (evidence.is_classified() || feature.frames > kMaxRejectionAge) continue;
    if (evidence.frames() < kClassificationFrames) continue;
    young.push_back(&feature);
    const PixelJacobians pixel = ego_motion_.jacobians().Lookup(feature.state.position);
    scores.push_back(evidence.Score(ego_motion_.motion().TranslationalFlow(pixel)));
  }
  const std::vector<bool> are_outliers = outlier_classifier_.Classify(scores);
  for (std::size_t i = 0; i < young.size(); ++i) {
    young[i]->outlier_evidence.Classify(are_outliers[i]);
    if (are_outliers[i]) rejected_.push_back(young[i]->id);
  }
}

}  // namespace evo::tracking
