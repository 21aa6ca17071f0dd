#include "evo/evaluation/track_accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "evo/core/error.hpp"

namespace evo::evaluation {

namespace {

constexpr double kUndetermined = std::numeric_limits<double>::quiet_NaN();
constexpr double kWholeTracks = std::numeric_limits<double>::infinity();
constexpr int kMaxThresholdPx = 31;       // of the expected feature age in [2]
constexpr std::size_t kMinPositions = 2;  // one has no age
constexpr int kMaxBins = 40;              // that a plot can show
constexpr double kBinRounding = 1e-6;     // in bins; an age on a bin's edge belongs to the next bin despite rounding

/// The part of a track within its feature age.
struct StablePart {
  std::size_t positions = 0;
  double age_s = 0.0;
};

StablePart FindStablePart(const TrackErrors& track, double threshold_px) {
  const auto end = std::ranges::find_if(track.errors_px, [&](double error) { return error > threshold_px; });
  const auto positions = static_cast<std::size_t>(end - track.errors_px.begin());
  return {positions, positions > 0 ? track.ages_s[positions - 1] : 0.0};
}

/// Linear between order statistics (numpy's default); `sorted` ascending.
double Quantile(const std::vector<double>& sorted, double probability) {
  if (sorted.empty()) return kUndetermined;
  const double rank = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (rank - std::floor(rank)) * (sorted[above] - sorted[below]);
}

double Mean(const std::vector<double>& values) { return ComputeStatistics(values).mean; }

double Median(const std::vector<double>& values) { return ComputeStatistics(values).median; }

double DistancePx(const events::TrackObservation& observation, const Eigen::Vector2d& position) {
  return std::hypot(observation.x - position.x(), observation.y - position.y());
}

/// Median error on the surface that a track follows best. Positions at which another surface is unknown but the track's
/// own point is known count as infinite errors.
double SurfaceError(const FeatureTrack& track, const TrueTrack& truth, const std::vector<double>& errors_px) {
  double min_error = Median(errors_px);
  for (const auto& positions : truth.other_surfaces) {
    std::vector<double> errors;
    for (std::size_t i = 1; i < positions.size(); ++i) {
      if (positions[i]) errors.push_back(DistancePx(track.observations[i], *positions[i]));
    }
    if (errors.size() < errors_px.size()) errors.resize(errors_px.size(), std::numeric_limits<double>::infinity());
    min_error = std::min(min_error, Median(errors));
  }
  return min_error;
}

void Compare(const FeatureTrack& track, const TrueTrack& truth, TrackErrors* result) {
  const auto first = std::ranges::find_if(truth.positions, [](const auto& p) { return p.has_value(); });
  if (first == truth.positions.end()) return;
  const auto begin = static_cast<std::size_t>(first - truth.positions.begin());
  const TimeNs start = track.observations[begin].t;
  std::size_t positions = 0;
  for (std::size_t i = begin; i < truth.positions.size(); ++i) {
    const auto& position = truth.positions[i];
    if (!position || (++positions == 1 && truth.starts_at_observation)) continue;
    const auto& observation = track.observations[i];
    result->ages_s.push_back(ToSeconds(observation.t - start));
    result->errors_px.push_back(DistancePx(observation, *position));
  }
  if (truth.visible_until) result->true_lifetime_s = ToSeconds(*truth.visible_until - start);
  if (positions < kMinPositions) result->status = TrackStatus::kTooShort;
  result->surface_error_px = SurfaceError(track, truth, result->errors_px);
}

TrackErrors CompareTrack(const FeatureTrack& track, const TrueTrack& truth, const std::vector<double>& thresholds) {
  const auto& observations = track.observations;
  TrackErrors result;
  result.id = track.id;
  result.start = observations.front().t;
  result.observations = static_cast<std::int64_t>(observations.size());
  result.lifetime_s = ToSeconds(observations.back().t - observations.front().t);
  result.status = truth.status;
  if (result.evaluated()) Compare(track, truth, &result);
  if (!result.evaluated()) return result;
  for (const double threshold : thresholds) result.feature_ages_s.push_back(FindStablePart(result, threshold).age_s);
  return result;
}

double ExpectedAgeNormalized(const std::vector<TrackErrors>& tracks, double threshold_px) {
  std::vector<double> ratios;
  for (const auto& track : tracks) {
    if (!track.evaluated() || !track.true_lifetime_s || !(*track.true_lifetime_s > 0.0)) continue;
    ratios.push_back(FindStablePart(track, threshold_px).age_s / *track.true_lifetime_s);
  }
  return Mean(ratios);
}

ThresholdAccuracy Summarize(const std::vector<TrackErrors>& tracks, double threshold_px) {
  std::vector<double> errors;
  std::vector<double> track_means;
  std::vector<double> track_medians;
  std::vector<double> ages;
  double evaluated = 0.0;
  double exceeding = 0.0;
  double median_exceeding = 0.0;
  double false_tracks = 0.0;
  for (const auto& track : tracks) {
    if (!track.evaluated()) continue;
    const StablePart stable = FindStablePart(track, threshold_px);
    const std::span<const double> good(track.errors_px.data(), stable.positions);
    errors.insert(errors.end(), good.begin(), good.end());
    evaluated += 1.0;
    if (stable.positions < track.errors_px.size()) {
      exceeding += 1.0;
      median_exceeding += Median(track.errors_px) > threshold_px ? 1.0 : 0.0;
      false_tracks += track.surface_error_px > threshold_px ? 1.0 : 0.0;
    }
    if (!(stable.age_s > 0.0)) continue;
    ages.push_back(stable.age_s);
    const Statistics error = ComputeStatistics(good);
    track_means.push_back(error.mean);
    track_medians.push_back(error.median);
  }
  ThresholdAccuracy result;
  result.threshold_px = threshold_px;
  result.error_px = ComputeStatistics(errors);
  std::ranges::sort(errors);
  result.error_quantiles_px = {Quantile(errors, 0.25), Quantile(errors, 0.75), Quantile(errors, 0.95),
                               Quantile(errors, 0.99)};
  result.track_error_mean_px = Mean(track_means);
  result.track_error_median_px = ComputeStatistics(track_medians).median;
  result.exceeding_ratio = exceeding / evaluated;
  result.median_exceeding_ratio = median_exceeding / evaluated;
  result.false_track_ratio = false_tracks / evaluated;
  result.outlier_ratio = 1.0 - static_cast<double>(ages.size()) / evaluated;
  result.feature_age_s = ComputeStatistics(ages);
  result.expected_age_s = std::accumulate(ages.begin(), ages.end(), 0.0) / evaluated;
  result.expected_age_normalized = ExpectedAgeNormalized(tracks, threshold_px);
  return result;
}

/// The smallest of 1, 2 or 5 times a power of ten that covers `max_age` with at most kMaxBins bins.
double BinWidth(double max_age) {
  double decade = std::pow(10.0, std::floor(std::log10(max_age / kMaxBins)));
  for (;; decade *= 10.0) {
    for (const double width : {decade, 2.0 * decade, 5.0 * decade}) {
      if (max_age < width * kMaxBins) return width;
    }
  }
}

std::vector<AgeBin> ErrorOverAge(const std::vector<TrackErrors>& tracks) {
  double max_age = 0.0;
  for (const auto& track : tracks) max_age = std::max(max_age, track.ages_s.empty() ? 0.0 : track.ages_s.back());
  if (!(max_age > 0.0)) return {};
  const double width = BinWidth(max_age);
  struct Content {
    std::vector<double> errors;
    std::set<std::int64_t> ids;
  };
  std::map<int, Content> contents;
  for (const auto& track : tracks) {
    for (std::size_t i = 0; i < track.ages_s.size(); ++i) {
      Content& content = contents[static_cast<int>(track.ages_s[i] / width + kBinRounding)];
      content.errors.push_back(track.errors_px[i]);
      content.ids.insert(track.id);
    }
  }
  std::vector<AgeBin> bins;
  for (auto& [index, content] : contents) {
    std::ranges::sort(content.errors);
    bins.push_back({index * width, (index + 1) * width, static_cast<std::int64_t>(content.ids.size()),
                    static_cast<std::int64_t>(content.errors.size()), Quantile(content.errors, 0.25),
                    Quantile(content.errors, 0.5), Quantile(content.errors, 0.75)});
  }
  return bins;
}

void CheckThresholds(std::vector<double>* thresholds_px) {
  std::ranges::sort(*thresholds_px);
  const bool valid =
      std::ranges::all_of(*thresholds_px, [](double threshold) { return std::isfinite(threshold) && threshold > 0.0; });
  if (!valid || thresholds_px->empty()) {
    throw Error(ErrorKind::kUsage, "thresholds of the track error must be positive (px)");
  }
  thresholds_px->erase(std::unique(thresholds_px->begin(), thresholds_px->end()), thresholds_px->end());
}

void RequireEvaluated(const TrackAccuracy& accuracy) {
  if (Count(accuracy, TrackStatus::kEvaluated) > 0) return;
  std::string reasons;
  for (const auto& [status, reason] :
       {std::pair{TrackStatus::kNoTruth, " without truth at their stamps or for their ids"},
        {TrackStatus::kNoDepth, " without a depth at their start"},
        {TrackStatus::kMovingObject, " on moving objects"},
        {TrackStatus::kNotTriangulated, " that cannot be triangulated"},
        {TrackStatus::kTooShort, " too short"}}) {
    const std::int64_t count = Count(accuracy, status);
    if (count > 0) reasons += (reasons.empty() ? "" : ", ") + std::to_string(count) + reason;
  }
  throw Error(ErrorKind::kNothingToDo,
              fmt::format("no track can be compared with the truth ({}): {}; do both belong to the same recording and "
                          "clock?",
                          accuracy.truth, reasons));
}

}  // namespace

std::int64_t Count(const TrackAccuracy& accuracy, TrackStatus status) {
  return std::ranges::count(accuracy.tracks, status, &TrackErrors::status);
}

TrackAccuracy EvaluateTracks(const std::vector<FeatureTrack>& tracks, const std::vector<TrueTrack>& truth,
                             const std::string& source, std::vector<double> thresholds_px) {
  CheckThresholds(&thresholds_px);
  TrackAccuracy accuracy;
  accuracy.truth = source;
  accuracy.thresholds_px = thresholds_px;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    accuracy.tracks.push_back(CompareTrack(tracks[i], truth[i], thresholds_px));
  }
  RequireEvaluated(accuracy);
  thresholds_px.push_back(kWholeTracks);
  for (const double threshold : thresholds_px) accuracy.thresholds.push_back(Summarize(accuracy.tracks, threshold));
  for (int threshold = 1; threshold <= kMaxThresholdPx; ++threshold) {
    accuracy.expected_age_normalized += ExpectedAgeNormalized(accuracy.tracks, threshold);
  }
  accuracy.expected_age_normalized /= kMaxThresholdPx;
  accuracy.error_over_age = ErrorOverAge(accuracy.tracks);
  return accuracy;
}

}  // namespace evo::evaluation
