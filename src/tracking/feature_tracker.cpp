#include "tracking/feature_tracker.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace evo::tracking {

namespace {

constexpr int kCoarseIterations = 6;
constexpr int kNewbornFrames = 5;      // until then a feature has to prove itself
constexpr double kJoltPx = 0.2;        // motion by a jolt that is not left to the features' own alignment
constexpr int kJoltPasses = 2;         // the first may be misled by features that took a neighbour for themselves
constexpr int kYouth = 12;             // frames after which a feature is judged for its oddity
constexpr double kSlowestPxS = 4.0;    // flow to which a change of shape is compared, at least
constexpr double kSlowdown = 0.9;      // of a feature without events, from frame to frame
constexpr double kFlowShare = 0.28;    // of the predicted flow's error that a window corrects, usually
constexpr double kLeastNews = 0.4;     // share of a window that a template has not seen, from which on it learns
constexpr int kSlopeFrames = 2;        // in which the neighbours of every feature are asked for its slope once
constexpr double kSlopeGain = 0.1;     // share of what one frame tells about the slope of a feature's plane
constexpr double kDepthGain = 0.25;    // and about its depth
constexpr double kSteepest = 1e-3;     // such a slope for a flow of 1 px/s, 1/px^2
constexpr double kRebaseScale = 1.25;  // re-sample the template when the patch has grown or shrunk this much,
constexpr double kRebaseBend = 0.25;   // or its depth varies by this share from its centre to its edge

/// By how much the flow that the events alone tell differs from the predicted one, px/s.
Eigen::Vector2d UnexpectedFlow(const FeatureAlignment& alignment) {
  return (alignment.motion.flow - alignment.start.flow) / kFlowShare;
}

}  // namespace

FeatureTracker::FeatureTracker(const geometry::Camera& camera, const TrackerOptions& options, ThreadPool* pool)
    : options_(options),
      width_(camera.width()),
      height_(camera.height()),
      pool_(pool),
      ego_motion_(camera),
      flow_field_(width_, height_, options),
      refill_(options),
      oddity_judge_(options.rejection_ratio) {}

void FeatureTracker::Process(const events::EventHistory& history, TimeNs t, const std::function<void()>& read_ahead) {
  if (last_) Track(history, t);
  if (options_.ego_motion) {
    const double step_s = last_ ? ToSeconds(t - *last_) : 0.0;
    // Neither can be split, but neither needs the other.
    pool_->ForEach(2, [&](std::size_t i) { i == 0 ? ego_motion_.Update(Flows(), step_s) : read_ahead(); });
    LearnDepths(step_s);
    WithdrawOdd();
  }
  last_ = t;
  detected_ = refill_.IsDue(features_.size());
  if (detected_) Refill(history, t);
}

events::Tracks FeatureTracker::Observations() const {
  events::Tracks observations;
  for (const auto& feature : features_) {
    if (feature.withdrawn) continue;
    observations.push_back({feature.id, *last_, feature.filtered.x(), feature.filtered.y()});
  }
  return observations;
}

std::vector<FlowSample> FeatureTracker::Flows() const {
  std::vector<FlowSample> flows;
  for (const auto& feature : features_) flows.push_back({feature.position, feature.flow});
  return flows;
}

std::vector<ObservedWindow> FeatureTracker::Windows() const {
  std::vector<ObservedWindow> windows;
  for (const auto& feature : features_) {
    if (feature.withdrawn) continue;
    windows.push_back({static_cast<float>(ToSeconds(feature.half_window)), feature.told_flow.cast<float>()});
  }
  return windows;
}

void FeatureTracker::Track(const events::EventHistory& history, TimeNs t) {
  AlignAll(history, t, {});
  if (options_.rotation_correction) FollowJolt(history, t);
  const double step_s = ToSeconds(t - *last_);
  const std::vector<Eigen::Vector2d> filtered = FilteredPositions(step_s);
  std::vector<char> alive(features_.size());
  pool_->ForEach(
      features_.size(), [&](std::size_t i) { alive[i] = Advance(alignments_[i], step_s, &features_[i]) ? 1 : 0; }, 4);
  for (std::size_t i = 0; i < features_.size(); ++i) features_[i].filtered = filtered[i];
  std::size_t kept = 0;
  for (std::size_t i = 0; i < features_.size(); ++i) {
    if (!alive[i]) continue;
    if (kept != i) features_[kept] = std::move(features_[i]);
    ++kept;
  }
  features_.erase(features_.begin() + static_cast<std::ptrdiff_t>(kept), features_.end());
}

void FeatureTracker::AlignAll(const events::EventHistory& history, TimeNs t, const RotationCorrection& jolt) {
  if (alignments_.size() < features_.size()) alignments_.resize(features_.size());
  pool_->ForEach(
      features_.size(), [&](std::size_t i) { Align(history, t, jolt, features_[i], &alignments_[i]); }, 4);
}

void FeatureTracker::FollowJolt(const events::EventHistory& history, TimeNs t) {
  RotationCorrection jolt;
  for (int i = 0; i < kJoltPasses; ++i) {
    const RotationCorrection further = EstimateRotationCorrection(PredictionResiduals());
    if (further.rms_motion_px <= kJoltPx) return;
    jolt.rotation += further.rotation;
    jolt.angular_velocity += further.angular_velocity;
    AlignAll(history, t, jolt);
  }
}

std::vector<Eigen::Vector2d> FeatureTracker::FilteredPositions(double step_s) {
  std::vector<FeatureStep> steps;
  for (std::size_t i = 0; i < features_.size(); ++i) {
    const FeatureAlignment& alignment = alignments_[i];
    const bool is_found = alignment.state == FeatureAlignment::State::kFound;
    const Eigen::Vector2d now = alignment.Landed();
    steps.push_back(
        {features_[i].filtered, now, is_found ? ego_motion_.EstimateInverseDepth({now, alignment.motion.flow}) : 0.0});
  }
  if (options_.epipolar_filter && ego_motion_.known()) {
    return epipolar_filter_.Filter(ego_motion_.motion(), ego_motion_.jacobians(), step_s, steps);
  }
  std::vector<Eigen::Vector2d> positions;
  for (const auto& step : steps) positions.push_back(step.measured);
  return positions;
}

std::vector<PredictionResidual> FeatureTracker::PredictionResiduals() const {
  std::vector<PredictionResidual> motions;
  for (std::size_t i = 0; i < features_.size(); ++i) {
    const FeatureAlignment& alignment = alignments_[i];
    if (alignment.state != FeatureAlignment::State::kFound) continue;
    motions.push_back({alignment.J_pixel_rotation, alignment.motion.offset, UnexpectedFlow(alignment)});
  }
  return motions;
}

TimeNs FeatureTracker::HalfWindowOf(const Eigen::Vector2d& flow) const {
  const TimeNs by_motion = HalfWindow(flow, options_.window_motion_px, options_);
  const double acceleration_px_s2 = ego_motion_.jacobians().focal_px() * ego_motion_.typical_angular_acceleration();
  const double straight_s = std::sqrt(2.0 * options_.window_curvature_px / std::max(acceleration_px_s2, 1.0));
  return std::min(by_motion, FromSeconds(std::max(straight_s, 0.5 * options_.min_window_s)));
}

PatchMotion FeatureTracker::Predict(const TrackedFeature& feature, double step_s, Eigen::Vector2d* position) const {
  const PatchFlow patch = ego_motion_.PredictPatchFlow({feature.position, feature.flow}, feature.slope);
  const Eigen::Vector2d flow = ego_motion_.ProjectToEpipolarLine({feature.position, feature.flow});
  PatchMotion motion;
  motion.flow = flow + step_s * patch.acceleration;
  motion.linear = (Eigen::Matrix2d::Identity() + step_s * patch.linear_rate) * feature.linear;
  motion.perspective = feature.perspective - step_s * feature.linear.transpose() * patch.quadratic_rate;
  motion.linear_rate = patch.linear_rate;
  motion.quadratic_rate = patch.quadratic_rate;
  *position = feature.position + 0.5 * step_s * (flow + motion.flow);
  return motion;
}

void FeatureTracker::Align(const events::EventHistory& history, TimeNs t, const RotationCorrection& jolt,
                           const TrackedFeature& feature, FeatureAlignment* alignment) const {
  FeatureAlignment& a = *alignment;
  a.state = FeatureAlignment::State::kLost;
  a.start = Predict(feature, ToSeconds(t - *last_), &a.position);
  a.J_pixel_rotation = ego_motion_.jacobians().Lookup(a.position).J_pixel_rotation;
  a.position += a.J_pixel_rotation * jolt.rotation;
  a.start.flow += a.J_pixel_rotation * jolt.angular_velocity;
  const auto gather = [&] {
    history.Gather({t, a.position.x(), a.position.y(), a.start.flow.x(), a.start.flow.y(),
                    static_cast<double>(options_.patch_radius_px), a.half_window},
                   &a.events);
    return a.events.size();
  };
  a.half_window = HalfWindowOf(a.start.flow);
  if (gather() < static_cast<std::size_t>(options_.min_events)) {
    a.half_window = std::min(2 * a.half_window, FromSeconds(0.5 * options_.max_window_s));
    const int fewest = feature.frames < kNewbornFrames ? options_.min_events : options_.min_events_established;
    if (gather() < static_cast<std::size_t>(fewest)) {
      if (MayRest(a, feature)) a.state = FeatureAlignment::State::kResting;
      return;
    }
  }
  a.events.Thin(static_cast<std::size_t>(options_.max_events));

  // In a jolt of its own a feature may lie beyond the fine association's reach.
  if (Fit(feature, false, &a) || Fit(feature, true, &a)) {
    a.state = FeatureAlignment::State::kFound;
  } else if (a.events.size() < static_cast<std::size_t>(options_.min_events) && MayRest(a, feature)) {
    a.state = FeatureAlignment::State::kResting;  // those are noise
  }
}

bool FeatureTracker::MayRest(const FeatureAlignment& alignment, const TrackedFeature& feature) const {
  return feature.frames >= kNewbornFrames && alignment.start.flow.norm() <= options_.resting_flow_px_s;
}

bool FeatureTracker::Advance(const FeatureAlignment& alignment, double step_s, TrackedFeature* feature) const {
  if (alignment.state == FeatureAlignment::State::kLost) return false;
  const bool is_found = alignment.state == FeatureAlignment::State::kFound;
  const PatchMotion& start = alignment.start;
  const PatchMotion& motion = is_found ? alignment.motion : start;
  ++feature->frames;
  feature->unlearnt_s += step_s;
  feature->half_window = alignment.half_window;
  feature->position = alignment.Landed();
  feature->linear = motion.linear;
  feature->perspective = motion.perspective;
  if (is_found) {
    feature->flow = motion.flow;
    feature->told_flow = start.flow + UnexpectedFlow(alignment);
    const Eigen::Matrix2d unexpected_rate =
        (motion.linear * start.linear.inverse() - Eigen::Matrix2d::Identity()) / step_s;
    feature->oddity.Add(motion.offset, unexpected_rate / (motion.flow.norm() + kSlowestPxS), alignment.stray_share);
    LearnSlope(unexpected_rate, feature);
    feature->self_bias = alignment.self_bias;
    UpdateTemplate(alignment.events, motion, feature);
  } else {
    feature->flow = kSlowdown * start.flow;
    feature->told_flow = feature->flow;
  }
  return IsInside(feature->position);
}

bool FeatureTracker::IsInside(const Eigen::Vector2d& position) const {
  const double border = options_.border_px;
  return position.x() >= border && position.y() >= border && position.x() <= width_ - 1 - border &&
         position.y() <= height_ - 1 - border;
}

void FeatureTracker::LearnDepths(double step_s) {
  if (!ego_motion_.known()) return;
  for (auto& feature : features_) {
    const double seen = ego_motion_.EstimateInverseDepth({feature.position, feature.flow});
    const double expected = ego_motion_.PropagateInverseDepth(feature.inverse_depth, step_s);
    const bool known = feature.inverse_depth > 0.0;
    feature.inverse_depth = known ? expected + std::max(kDepthGain, 1.0 / feature.frames) * (seen - expected) : seen;
  }
  const std::vector<DepthSample> depths = Depths();
  pool_->ForEach(
      features_.size(),
      [&](std::size_t i) {
        if ((features_[i].id + features_[i].frames) % kSlopeFrames != 0) return;
        const auto slope = FitInverseDepthGradient(depths, depths[i]);
        if (slope) features_[i].slope = *slope;
      },
      4);
}

void FeatureTracker::WithdrawOdd() {
  withdrawn_.clear();
  if (!ego_motion_.known()) return;
  std::vector<TrackedFeature*> young;
  std::vector<Oddity> oddities;
  for (auto& feature : features_) {
    if (feature.judged || feature.frames > kOldestWithdrawn || feature.oddity.frames() < kYouth) continue;
    feature.judged = true;
    young.push_back(&feature);
    oddities.push_back(feature.oddity.Of(ego_motion_.motion().TranslationalFlow(ego_motion_.jacobians().Lookup(feature.position))));
  }
  const std::vector<bool> are_odd = oddity_judge_.AreOdd(oddities);
  for (std::size_t i = 0; i < young.size(); ++i) {
    if (!are_odd[i]) continue;
    young[i]->withdrawn = true;
    withdrawn_.push_back(young[i]->id);
  }
}

std::vector<DepthSample> FeatureTracker::Depths() const {
  std::vector<DepthSample> depths;
  for (const auto& feature : features_) depths.push_back({feature.position, feature.inverse_depth});
  return depths;
}

void FeatureTracker::LearnSlope(const Eigen::Matrix2d& unexpected_rate, TrackedFeature* feature) const {
  feature->slope += kSlopeGain * ego_motion_.EstimateInverseDepthGradient(feature->position, unexpected_rate);
  const double steepest = kSteepest * feature->flow.norm();
  const double slope = feature->slope.norm();
  if (slope > steepest) feature->slope *= steepest / slope;
}

bool FeatureTracker::Fit(const TrackedFeature& feature, bool coarse_first, FeatureAlignment* alignment) const {
  thread_local AssociationTable field;
  PatchMotion& motion = alignment->motion;
  motion = alignment->start;
  const auto radius = static_cast<double>(options_.patch_radius_px);
  const auto build = [&](double sigma_px) { field.Build(feature.events, sigma_px, options_.outlier_density_ratio); };
  const auto self_bias = [&] { return field.ComputeSelfBias(feature.events, motion.linear, radius); };
  const auto align = [&](const SelfBias& own, int iterations, bool with_linear) {
    return AlignToTemplate(
        alignment->events, field, planes(),
        {iterations, radius, ToSeconds(alignment->half_window), options_.flow_prior, options_.affine_prior, own},
        with_linear, &motion);
  };
  if (coarse_first) {
    build(options_.coarse_sigma_px);
    align(self_bias(), kCoarseIterations, false);
  }
  build(options_.fine_sigma_px);
  alignment->self_bias = feature.self_bias ? *feature.self_bias : self_bias();
  const AlignmentQuality quality = align(alignment->self_bias, options_.iterations, true);
  alignment->stray_share = 1.0 - quality.inlier_ratio;
  const double scale = feature.scale * std::sqrt(std::abs(motion.linear.determinant()));
  return quality.inlier_ratio >= options_.min_inlier_ratio && quality.residual_px <= options_.max_residual_px &&
         motion.offset.norm() <= options_.max_prediction_error_px && scale < options_.max_scale &&
         scale > 1.0 / options_.max_scale;
}

void FeatureTracker::UpdateTemplate(const events::LocalEvents& events, const PatchMotion& motion,
                                    TrackedFeature* feature) const {
  // A running mean at first, then one that forgets: the patch changes as it comes nearer. A window that mostly repeats
  // the last one has little news, and all that it would add is its own error of alignment.
  const double news = std::min(1.0, feature->unlearnt_s / (2.0 * ToSeconds(feature->half_window)));
  if (news < kLeastNews) return;
  feature->unlearnt_s = 0.0;
  ++feature->windows;
  const double gain = std::max(1.0 - std::pow(1.0 - options_.template_gain, news), 1.0 / feature->windows);
  thread_local std::optional<EventHistogram> window;
  if (!window || window->side() != feature->events.side() || window->planes() != feature->events.planes()) {
    window.emplace(feature->events.radius(), feature->events.planes());
  }
  window->Clear();
  Accumulate(events, motion, &*window);
  // Windows weigh the same however many events they hold.
  feature->events.Blend(static_cast<float>(1.0 - gain), *window,
                        static_cast<float>(gain / std::max(1.0, window->Total())));
  const double growth = std::sqrt(std::abs(feature->linear.determinant()));
  const double bent = feature->perspective.norm() * options_.patch_radius_px;
  if (growth > kRebaseScale || growth < 1.0 / kRebaseScale || bent > kRebaseBend) {
    feature->events = feature->events.Warped(feature->linear, feature->perspective);
    feature->perspective.setZero();
    feature->scale *= growth;
    feature->linear.setIdentity();
  }
  feature->self_bias.reset();
}

}  // namespace evo::tracking
