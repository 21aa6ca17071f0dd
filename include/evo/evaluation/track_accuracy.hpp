#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/evaluation/statistics.hpp"
#include "evo/evaluation/track_truth.hpp"

namespace evo::evaluation {

// Feature age and track error as defined by
//   [1] D. Gehrig, H. Rebecq, G. Gallego, D. Scaramuzza: EKLT, IJCV 2019, and its rpg_feature_tracking_analysis;
//   [2] N. Messikommer, C. Fang, M. Gehrig, D. Scaramuzza: Data-driven Feature Tracking for Event Cameras, CVPR 2023.
//
// The track error is the distance between a track and its true track (px). The feature age at a threshold is the time
// from the first position with a truth to the last one before the error first exceeds the threshold, or to the end of
// the track. A track of feature age 0 is an outlier at that threshold, any other is stable. Error statistics at a
// threshold include only positions within the feature age.
//
// A false track follows none of the surfaces around its start: its median error exceeds the threshold on each of them,
// see TrueTrack::other_surfaces.
//
// Differences: [1] and [2] interpolate the track at the stamps of the truth, here the truth is interpolated at the
// stamps of the track. [1] evaluates only the tracks that start with the file, here all are evaluated. [2] ends the age
// one stamp earlier and extends asynchronous tracks over the whole true track, here a track ends at its last
// observation.

/// Errors of one track.
struct TrackErrors {
  std::int64_t id = 0;
  TimeNs start = 0;               ///< first observation
  std::int64_t observations = 0;  ///< with and without truth
  double lifetime_s = 0.0;        ///< last observation minus the first
  TrackStatus status = TrackStatus::kNoTruth;
  // The rest is set for evaluated tracks.
  std::vector<double> ages_s;             ///< of the compared positions, since the first one with a truth
  std::vector<double> errors_px;          ///< of the same positions
  double surface_error_px = 0.0;          ///< median error on the surface that the track follows best
  std::optional<double> true_lifetime_s;  ///< time for which the point is visible; empty if unknown
  std::vector<double> feature_ages_s;     ///< one for each threshold

  bool evaluated() const { return status == TrackStatus::kEvaluated; }
};

/// Track error within the feature age at one threshold (px).
struct TrackErrorQuantiles {
  double p25 = 0.0;
  double p75 = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
};

/// All evaluated tracks at one threshold; NaN where a quantity is unknown or there is nothing to average.
struct ThresholdAccuracy {
  double threshold_px = 0.0;  ///< infinity: whole tracks
  Statistics error_px;        ///< over all positions within the feature ages
  TrackErrorQuantiles error_quantiles_px;
  double track_error_mean_px = 0.0;     ///< mean over stable tracks of their mean errors, "tracking error" of [2]
  double track_error_median_px = 0.0;   ///< median over stable tracks of their median errors
  double exceeding_ratio = 0.0;         ///< tracks whose error ever exceeds the threshold
  double median_exceeding_ratio = 0.0;  ///< tracks whose median error over the whole track does
  double false_track_ratio = 0.0;       ///< tracks that follow no surface
  double outlier_ratio = 0.0;           ///< tracks of feature age 0
  Statistics feature_age_s;             ///< over stable tracks
  /// Mean feature age of stable tracks times their ratio, "expected feature age" of [2]. It equals the mean over all
  /// tracks with age 0 for outliers, "feature age" of [1].
  double expected_age_s = 0.0;
  /// The same with each age over the true lifetime, 1 for a perfect tracker. Only tracks with a known true lifetime
  /// above 0 count.
  double expected_age_normalized = 0.0;
};

/// Errors of positions of one age.
struct AgeBin {
  double low_s = 0.0;
  double high_s = 0.0;  ///< exclusive
  std::int64_t tracks = 0;
  std::int64_t positions = 0;
  double p25_px = 0.0;
  double median_px = 0.0;
  double p75_px = 0.0;
};

struct TrackAccuracy {
  std::string truth;                          ///< source of the truth: tracks, depth or triangulated
  std::vector<double> thresholds_px;          ///< ascending
  std::vector<TrackErrors> tracks;            ///< in order of id
  std::vector<ThresholdAccuracy> thresholds;  ///< one for each threshold, then one for whole tracks
  double expected_age_normalized = 0.0;       ///< mean over the thresholds 1, 2, ..., 31 px as in [2]; NaN if unknown
  std::vector<AgeBin> error_over_age;         ///< equal widths of 1, 2 or 5 times a power of ten, without empty bins
};

/// Number of tracks with this status.
std::int64_t Count(const TrackAccuracy& accuracy, TrackStatus status);

/// Evaluates `tracks` against `truth`, which belongs to them one by one and comes from `source`; `thresholds_px` may be
/// in any order. Throws Error: kUsage for thresholds that are not positive, kNothingToDo if no track can be evaluated.
TrackAccuracy EvaluateTracks(const std::vector<FeatureTrack>& tracks, const std::vector<TrueTrack>& truth,
                             const std::string& source, std::vector<double> thresholds_px);

}  // namespace evo::evaluation
