#include "evo/tracking/feature_tracker.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "evo/tracking/corner_detector.hpp"

namespace evo {

namespace {

constexpr int kTemplateMarginPx = 4;  // the template is larger than the patch, for events that stick out
constexpr int kCoarseIterations = 6;
constexpr double kRebaseScale = 1.25;  // re-sample the template when the patch has grown or shrunk this much

void Vote(const LocalEvents& events, const PatchMotion& motion, DensityMap* map) {
  const Eigen::Matrix2f inverse = motion.linear.inverse().cast<float>();
  const Eigen::Vector2f offset = motion.offset.cast<float>();
  const Eigen::Vector2f flow = motion.flow.cast<float>();
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Eigen::Vector2f u = inverse * Eigen::Vector2f(events.x[i] - offset.x() - flow.x() * events.dt[i],
                                                        events.y[i] - offset.y() - flow.y() * events.dt[i]);
    map->Vote(u.x(), u.y(), map->PlaneOf(events.polarity[i]), 1.0f);
  }
}

}  // namespace

FeatureTracker::FeatureTracker(int width, int height, const TrackerOptions& options, ThreadPool* pool)
    : options_(options),
      width_(width),
      height_(height),
      pool_(pool),
      flow_field_(width, height, options),
      refill_(options) {}

void FeatureTracker::Process(const EventHistory& history, TimeNs t) {
  if (last_) {
    std::vector<char> alive(features_.size());
    pool_->ForEach(
        features_.size(), [&](std::size_t i) { alive[i] = Track(history, t, &features_[i]) ? 1 : 0; }, 4);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < features_.size(); ++i) {
      if (!alive[i]) continue;
      if (kept != i) features_[kept] = std::move(features_[i]);
      ++kept;
    }
    features_.erase(features_.begin() + static_cast<std::ptrdiff_t>(kept), features_.end());
  }
  last_ = t;
  detected_ = refill_.IsDue(features_.size());
  if (detected_) Refill(history, t);
}

Tracks FeatureTracker::Observations() const {
  Tracks observations;
  for (const auto& feature : features_) {
    observations.push_back({feature.id, *last_, feature.position.x(), feature.position.y()});
  }
  return observations;
}

bool FeatureTracker::Track(const EventHistory& history, TimeNs t, TrackedFeature* feature) const {
  if (!Align(history, t, feature)) return false;
  ++feature->frames;
  const double b = options_.border_px;
  const auto& p = feature->position;
  return p.x() >= b && p.y() >= b && p.x() <= width_ - 1 - b && p.y() <= height_ - 1 - b;
}

bool FeatureTracker::Align(const EventHistory& history, TimeNs t, TrackedFeature* feature) const {
  thread_local LocalEvents events;
  const Eigen::Vector2d predicted = feature->position + ToSeconds(t - *last_) * feature->flow;
  const TimeNs half_window = HalfWindow(feature->flow, options_.window_motion_px, options_);
  history.Gather({t, predicted.x(), predicted.y(), feature->flow.x(), feature->flow.y(),
                  static_cast<double>(options_.patch_radius_px), half_window},
                 &events);
  if (events.size() < static_cast<std::size_t>(options_.fewest_events)) return false;
  events.Thin(static_cast<std::size_t>(options_.most_events));

  PatchMotion motion{Eigen::Vector2d::Zero(), feature->flow, feature->linear};
  if (!Fit(events, *feature, half_window, false, &motion)) {
    // A jolt: the prediction may lie beyond the fine association's reach.
    motion = {Eigen::Vector2d::Zero(), feature->flow, feature->linear};
    if (!Fit(events, *feature, half_window, true, &motion)) return false;
  }
  feature->position = predicted + motion.offset;
  feature->flow = motion.flow;
  feature->linear = motion.linear;
  UpdateTemplate(events, motion, feature);
  return true;
}

bool FeatureTracker::Fit(const LocalEvents& events, const TrackedFeature& feature, TimeNs half_window,
                         bool coarse_first, PatchMotion* motion) const {
  thread_local AssociationField field;
  const auto align = [&](double sigma_px, int iterations, bool with_linear) {
    const auto radius = static_cast<double>(options_.patch_radius_px);
    field.Build(feature.events, sigma_px, options_.outlier_share);
    return AlignToTemplate(events, field, planes(),
                           {iterations, radius, ToSeconds(half_window), options_.flow_prior, options_.affine_prior,
                            field.OwnMoments(feature.events, motion->linear, radius)},
                           with_linear, motion);
  };
  if (coarse_first) align(options_.coarse_sigma_px, kCoarseIterations, false);
  const AlignmentQuality quality = align(options_.fine_sigma_px, options_.iterations, true);
  const double scale = feature.scale * std::sqrt(std::abs(motion->linear.determinant()));
  return quality.inlier_share >= options_.fewest_inliers && quality.residual_px <= options_.largest_residual_px &&
         motion->offset.norm() <= options_.largest_jump_px && scale < options_.largest_scale &&
         scale > 1.0 / options_.largest_scale;
}

void FeatureTracker::UpdateTemplate(const LocalEvents& events, const PatchMotion& motion,
                                    TrackedFeature* feature) const {
  // A running mean at first, then one that forgets: the patch changes as it comes nearer.
  const double gain = std::max(options_.template_gain, 1.0 / (feature->frames + 1.0));
  feature->events.Scale(static_cast<float>(1.0 - gain));
  thread_local std::optional<DensityMap> window;
  if (!window || window->side() != feature->events.side() || window->planes() != feature->events.planes()) {
    window.emplace(feature->events.radius(), feature->events.planes());
  }
  window->Clear();
  Vote(events, motion, &*window);
  // Windows weigh the same however many events they hold.
  feature->events.Add(*window, static_cast<float>(gain / std::max(1.0, window->Total())));
  const double growth = std::sqrt(std::abs(feature->linear.determinant()));
  if (growth > kRebaseScale || growth < 1.0 / kRebaseScale) {
    feature->events = feature->events.Warped(feature->linear);
    feature->scale *= growth;
    feature->linear.setIdentity();
  }
}

void FeatureTracker::Refill(const EventHistory& history, TimeNs t) {
  std::vector<FlowSample> samples;
  std::vector<Eigen::Vector2d> taken;
  for (const auto& feature : features_) {
    samples.push_back({feature.position, feature.flow});
    taken.push_back(feature.position);
  }
  flow_field_.Update(history, t, samples, pool_);
  const cv::Mat image = CorrectedEventImage(history, t, flow_field_, options_.corner_window_motion_px, options_, pool_);
  const double fewest_events = options_.fewest_events * options_.corner_window_motion_px / options_.window_motion_px;
  const int missing = options_.features - static_cast<int>(features_.size());
  const auto corners = DetectCorners(image, taken, missing, fewest_events, options_, pool_);
  std::vector<std::optional<TrackedFeature>> born(corners.size());
  pool_->ForEach(corners.size(), [&](std::size_t i) { born[i] = Birth(history, t, corners[i]); });
  for (auto& feature : born) {
    if (!feature) continue;
    feature->id = next_id_++;
    features_.push_back(std::move(*feature));
  }
}

std::optional<TrackedFeature> FeatureTracker::Birth(const EventHistory& history, TimeNs t,
                                                    const Eigen::Vector2d& position) const {
  Eigen::Vector2d flow = flow_field_.At(position.x(), position.y());
  if (!EstimateFlow(history, t, position.x(), position.y(), options_, &flow)) return std::nullopt;
  thread_local LocalEvents events;
  const TimeNs half_window = HalfWindow(flow, options_.window_motion_px, options_);
  history.Gather(
      {t, position.x(), position.y(), flow.x(), flow.y(), static_cast<double>(options_.patch_radius_px), half_window},
      &events);
  if (events.size() < static_cast<std::size_t>(options_.fewest_events)) return std::nullopt;
  TrackedFeature feature{0,    position,
                         flow, Eigen::Matrix2d::Identity(),
                         1.0,  DensityMap(options_.patch_radius_px + kTemplateMarginPx, planes()),
                         1};
  Vote(events, {Eigen::Vector2d::Zero(), flow, Eigen::Matrix2d::Identity()}, &feature.events);
  if (feature.events.EffectiveCells() < options_.fewest_cells) return std::nullopt;
  feature.events.Scale(static_cast<float>(1.0 / feature.events.Total()));
  return feature;
}

}  // namespace evo
