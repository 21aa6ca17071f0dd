#include "tracking/detection/feature_initializer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "tracking/detection/corner_detector.hpp"
#include "tracking/detection/flow_estimation.hpp"
#include "tracking/detection/motion_compensated_image.hpp"
#include "tracking/event_window.hpp"

namespace evo::tracking {

namespace {

constexpr int kTemplateMarginPx = 4;           // the template exceeds the patch, which grows and moves against it
constexpr double kCandidatesPerFeature = 1.5;  // corners tried for each missing feature: many do not become one
constexpr double kInformationSigmaPx = 1.0;    // standard deviation of the densities that are asked for information
constexpr double kInformationOutlierDensityRatio = 0.2;
// Log likelihood ratio of each half of a window under the other, nats an event: that of noise is negative.
constexpr double kMinCrossLikelihoodRatio = 0.1;
constexpr std::size_t kMaxRecent = 200;  // candidates to compare with: enough for a quantile, few enough to be recent

/// What the two halves of a window tell of each other: a moving pattern repeats itself, noise does not.
class WindowHalves {
 public:
  WindowHalves(int radius_px, int planes)
      : histograms_{EventHistogram(radius_px, planes), EventHistogram(radius_px, planes)} {}

  /// Memory that each thread keeps.
  static WindowHalves& ForThread(int radius_px, int planes) {
    thread_local std::map<std::pair<int, int>, WindowHalves> halves;
    return halves.try_emplace({radius_px, planes}, radius_px, planes).first->second;
  }

  void Split(const events::LocalEvents& events, const PatchMotion& motion) {
    for (std::size_t i = 0; i < events_.size(); ++i) {
      events_[i].resize(0);
      histograms_[i].Clear();
    }
    for (std::size_t i = 0; i < events.size(); ++i) {
      events_[events.dt[i] > 0.0f ? 1 : 0].push_back(events.x[i], events.y[i], events.dt[i], events.polarity[i]);
    }
    for (std::size_t i = 0; i < events_.size(); ++i) {
      Accumulate(events_[i], motion, &histograms_[i]);
      tables_[i].Build(histograms_[i], kInformationSigmaPx, kInformationOutlierDensityRatio);
    }
  }

  /// Information of an event of `all` in the direction in which the events constrain the position least, as far as the
  /// halves agree, 1/px^2.
  double SmallestInformation(const EventHistogram& all) const {
    const Eigen::Matrix2d information = tables_[0].Information(all, tables_[1]);
    const double mean = 0.5 * information.trace();
    return mean - std::sqrt(std::max(0.0, mean * mean - information.determinant()));  // the smaller eigenvalue
  }
  /// Log likelihood ratio of the events of each half under the pattern of the other: the mean of both, nats an event.
  double LogLikelihoodRatio(const PatchMotion& motion) const {
    return 0.5 * (MeanLogLikelihoodRatio(events_[0], tables_[1], histograms_[1].planes(), motion) +
                  MeanLogLikelihoodRatio(events_[1], tables_[0], histograms_[0].planes(), motion));
  }

 private:
  std::array<EventHistogram, 2> histograms_;
  std::array<events::LocalEvents, 2> events_;
  std::array<AssociationTable, 2> tables_;
};

}  // namespace

FeatureInitializer::FeatureInitializer(int width, int height, const TrackerOptions& options,
                                       const EgoMotion& ego_motion, ThreadPool* pool)
    : options_(options),
      area_(width, height, options.border_px),
      ego_motion_(ego_motion),
      pool_(pool),
      refill_(options),
      flow_field_(width, height, options) {}

void FeatureInitializer::AddFeatures(const events::EventHistory& history, TimeNs t,
                                     std::vector<TrackedFeature>* features) {
  const std::vector<DepthSample> depths = DepthSamples(*features);
  UpdateFlowField(history, t, *features, depths);
  const std::vector<Eigen::Vector2d> corners = FindCorners(history, t, *features);
  std::vector<std::optional<Candidate>> made(corners.size());
  pool_->ForEach(corners.size(), [&](std::size_t i) { made[i] = MakeCandidate(history, t, corners[i], depths); });
  std::vector<Candidate> candidates;
  for (auto& candidate : made) {
    if (candidate) candidates.push_back(std::move(*candidate));
  }
  const double min_information = MinInformation(candidates);
  std::ranges::stable_sort(candidates, std::ranges::greater(), &Candidate::information);
  for (auto& candidate : candidates) {
    if (features->size() >= static_cast<std::size_t>(options_.features)) break;
    if (candidate.information < min_information) break;
    candidate.feature.id = next_id_++;
    features->push_back(std::move(candidate.feature));
  }
}

void FeatureInitializer::UpdateFlowField(const events::EventHistory& history, TimeNs t,
                                         const std::vector<TrackedFeature>& features,
                                         const std::vector<DepthSample>& depths) {
  const auto predict = [&](const Eigen::Vector2d& position) -> std::optional<Eigen::Vector2d> {
    if (!ego_motion_.known()) return std::nullopt;
    const auto inverse_depth = MedianInverseDepth(depths, position);
    if (!inverse_depth) return std::nullopt;
    return ego_motion_.PredictFlow(position, *inverse_depth);
  };
  flow_field_.Update(history, t, FlowSamples(features), predict, pool_);
}

std::vector<Eigen::Vector2d> FeatureInitializer::FindCorners(const events::EventHistory& history, TimeNs t,
                                                             const std::vector<TrackedFeature>& features) const {
  std::vector<Eigen::Vector2d> taken;
  for (const auto& feature : features) taken.push_back(feature.state.position);
  const cv::Mat image =
      MotionCompensatedImage(history, t, flow_field_, options_.corner_window_motion_px, options_, pool_);
  const double min_events = options_.min_events * options_.corner_window_motion_px / options_.window_motion_px;
  const auto missing = static_cast<std::size_t>(options_.features) - features.size();
  const auto count = static_cast<int>(kCandidatesPerFeature * static_cast<double>(missing));
  const auto lives_long_enough = [&](const Eigen::Vector2d& corner) {
    return area_.Contains(corner + options_.min_expected_lifetime_s * flow_field_.Interpolate(corner));
  };
  return DetectCorners(image, taken, count, min_events, options_, pool_, lives_long_enough);
}

std::optional<FeatureInitializer::Candidate> FeatureInitializer::MakeCandidate(
    const events::EventHistory& history, TimeNs t, const Eigen::Vector2d& position,
    const std::vector<DepthSample>& depths) const {
  Eigen::Vector2d flow = flow_field_.Interpolate(position);
  if (!EstimateFlow(history, t, position, options_, &flow)) return std::nullopt;
  if (!ego_motion_.MayBeStatic({position, flow})) return std::nullopt;
  thread_local events::LocalEvents events;
  TimeNs half_window = FeatureHalfWindow(flow, ego_motion_, options_);
  const auto has_events = [&] {
    const auto radius = static_cast<double>(options_.patch_radius_px);
    history.Gather({t, position.x(), position.y(), flow.x(), flow.y(), radius, half_window}, &events);
    return events.size() >= static_cast<std::size_t>(options_.min_events);
  };
  if (!has_events()) {
    half_window = DoubledHalfWindow(half_window, options_);
    if (!has_events()) return std::nullopt;
  }
  const double inverse_depth = ego_motion_.EstimateInverseDepth({position, flow});
  const Eigen::Vector2d gradient =
      FitInverseDepthGradient(depths, {position, inverse_depth}).value_or(Eigen::Vector2d::Zero());
  const PatchFlow patch = ego_motion_.PredictPatchFlow({position, flow}, gradient);
  PatchMotion motion;
  motion.flow = flow;
  motion.linear_rate = patch.linear_rate;
  motion.quadratic_rate = patch.quadratic_rate;
  EventHistogram histogram(options_.patch_radius_px + kTemplateMarginPx, options_.use_polarity ? 2 : 1);
  Accumulate(events, motion, &histogram);
  if (histogram.EffectiveCells() < options_.min_template_area_px) return std::nullopt;
  WindowHalves& halves = WindowHalves::ForThread(histogram.radius(), histogram.planes());
  halves.Split(events, motion);
  if (halves.LogLikelihoodRatio(motion) < kMinCrossLikelihoodRatio) return std::nullopt;
  const double information = halves.SmallestInformation(histogram);
  return Candidate{.feature = {.state = {position, position, flow, {}},
                               .window = {half_window, flow},
                               .surface = {inverse_depth, gradient},
                               .event_template = FeatureTemplate(std::move(histogram), VelocityInTemplate(motion))},
                   .information = information};
}

double FeatureInitializer::MinInformation(const std::vector<Candidate>& candidates) {
  for (const auto& candidate : candidates) recent_informations_.push_back(candidate.information);
  while (recent_informations_.size() > kMaxRecent) recent_informations_.pop_front();
  std::vector<double> sorted(recent_informations_.begin(), recent_informations_.end());
  const auto refused = static_cast<std::ptrdiff_t>(options_.uninformative_ratio * static_cast<double>(sorted.size()));
  if (refused == 0) return -std::numeric_limits<double>::infinity();
  std::ranges::nth_element(sorted, sorted.begin() + refused);
  return sorted[static_cast<std::size_t>(refused)];
}

}  // namespace evo::tracking
