#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tracking/detection/corner_detector.hpp"
#include "tracking/feature_tracker.hpp"

namespace evo::tracking {

namespace {

constexpr int kTemplateMarginPx = 4;  // the template is larger than the patch, for events that stick out
constexpr double kCandidates = 1.5;   // corners tried for each feature that is missing: many are no features
// Of the densities that are asked for information.
constexpr double kInformationSigmaPx = 1.0;
constexpr double kInformationOutlierShare = 0.2;
constexpr std::size_t kRemembered = 200;  // features with which a new one is compared

/// Of an event, in the direction in which the events tell least of where they are, as far as both halves of the window
/// say the same: neither noise nor a pattern that does not keep its shape tells anything.
double SmallestInformation(const events::LocalEvents& events, const PatchMotion& motion, const EventHistogram& all) {
  thread_local TemplatePoints points;
  thread_local std::array<AssociationTable, 2> fields;
  points.Update(events, motion);
  std::array<EventHistogram, 2> halves{EventHistogram(all.radius(), all.planes()), EventHistogram(all.radius(), all.planes())};
  for (std::size_t i = 0; i < events.size(); ++i) {
    EventHistogram& half = halves[events.dt[i] > 0.0f ? 1 : 0];
    half.Vote(points.u[i], points.v[i], half.PlaneOf(events.polarity[i]), 1.0f);
  }
  for (std::size_t i = 0; i < halves.size(); ++i) {
    fields[i].Build(halves[i], kInformationSigmaPx, kInformationOutlierShare);
  }
  const Eigen::Matrix2d m = fields[0].Information(all, fields[1]);
  const double mean = 0.5 * m.trace();
  return mean - std::sqrt(std::max(0.0, mean * mean - m.determinant()));
}

}  // namespace

void FeatureTracker::Refill(const events::EventHistory& history, TimeNs t) {
  std::vector<Eigen::Vector2d> taken;
  for (const auto& feature : features_) taken.push_back(feature.position);
  const std::vector<DepthSample> depths = Depths();
  const auto guess = [&](const Eigen::Vector2d& position) -> std::optional<Eigen::Vector2d> {
    if (!ego_motion_.known()) return std::nullopt;
    const auto inverse_depth = MedianInverseDepth(depths, position);
    if (!inverse_depth) return std::nullopt;
    return ego_motion_.PredictFlow(position, *inverse_depth);
  };
  flow_field_.Update(history, t, Flows(), guess, pool_);
  const cv::Mat image = CorrectedEventImage(history, t, flow_field_, options_.corner_window_motion_px, options_, pool_);
  const double min_events = options_.min_events * options_.corner_window_motion_px / options_.window_motion_px;
  const auto missing = static_cast<std::size_t>(options_.features) - features_.size();
  const auto candidates = static_cast<int>(kCandidates * static_cast<double>(missing));
  const auto stays = [&](const Eigen::Vector2d& corner) {
    return IsInside(corner + options_.min_expected_lifetime_s * flow_field_.At(corner.x(), corner.y()));
  };
  const auto corners = DetectCorners(image, taken, candidates, min_events, options_, pool_, stays);
  std::vector<std::optional<TrackedFeature>> born(corners.size());
  pool_->ForEach(corners.size(), [&](std::size_t i) { born[i] = Birth(history, t, corners[i], depths); });
  std::vector<TrackedFeature> fit;
  for (auto& feature : born) {
    if (feature) fit.push_back(std::move(*feature));
  }
  const double least = LeastInformation(fit);
  std::ranges::stable_sort(fit, std::ranges::greater(), &TrackedFeature::information);
  for (auto& feature : fit) {
    if (features_.size() >= static_cast<std::size_t>(options_.features)) break;
    if (feature.information < least) break;
    feature.id = next_id_++;
    features_.push_back(std::move(feature));
  }
}

double FeatureTracker::LeastInformation(const std::vector<TrackedFeature>& born) {
  for (const auto& feature : born) informations_.push_back(feature.information);
  while (informations_.size() > kRemembered) informations_.pop_front();
  std::vector<double> all(informations_.begin(), informations_.end());
  const auto refused = static_cast<std::ptrdiff_t>(options_.uninformative_ratio * static_cast<double>(all.size()));
  if (refused == 0) return -std::numeric_limits<double>::infinity();
  std::ranges::nth_element(all, all.begin() + refused);
  return all[static_cast<std::size_t>(refused)];
}

std::optional<TrackedFeature> FeatureTracker::Birth(const events::EventHistory& history, TimeNs t,
                                                    const Eigen::Vector2d& position,
                                                    const std::vector<DepthSample>& depths) const {
  Eigen::Vector2d flow = flow_field_.At(position.x(), position.y());
  if (!EstimateFlow(history, t, position.x(), position.y(), options_, &flow)) return std::nullopt;
  if (!ego_motion_.MayBeStatic({position, flow})) return std::nullopt;
  thread_local events::LocalEvents events;
  const TimeNs half_window = HalfWindowOf(flow);
  history.Gather(
      {t, position.x(), position.y(), flow.x(), flow.y(), static_cast<double>(options_.patch_radius_px), half_window},
      &events);
  if (events.size() < static_cast<std::size_t>(options_.min_events)) return std::nullopt;
  const double inverse_depth = ego_motion_.EstimateInverseDepth({position, flow});
  TrackedFeature feature{.position = position,
                         .filtered = position,
                         .flow = flow,
                         .inverse_depth = inverse_depth,
                         .slope = FitInverseDepthGradient(depths, {position, inverse_depth}).value_or(Eigen::Vector2d::Zero()),
                         .events = EventHistogram(options_.patch_radius_px + kTemplateMarginPx, planes()),
                         .half_window = half_window,
                         .told_flow = flow};
  const PatchFlow patch = ego_motion_.PredictPatchFlow({position, flow}, feature.slope);
  PatchMotion motion;
  motion.flow = flow;
  motion.linear_rate = patch.linear_rate;
  motion.quadratic_rate = patch.quadratic_rate;
  Accumulate(events, motion, &feature.events);
  if (feature.events.EffectiveCells() < options_.min_template_area_px) return std::nullopt;
  feature.information = SmallestInformation(events, motion, feature.events);
  feature.events.Scale(static_cast<float>(1.0 / feature.events.Total()));
  return feature;
}

}  // namespace evo::tracking
