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
// The error is the distance of a track to its true track, px. The feature age at a threshold is the time from the
// first position that has a truth to the last one before the error first exceeds the threshold, or to the end of the
// track. A track is stable at a threshold if its age there is not 0. Error statistics at a threshold take only what
// lies within the feature age.
// A stray track follows none of the surfaces around the place where it begins: its median error exceeds the threshold
// whichever of them it is said to be on, see TrueTrack::beside.
// Where this differs: [1] and [2] interpolate the track at the stamps of the truth, here it is the other way round; [1]
// judges only the tracks that begin with the file, here all are judged; [2] ends the age one stamp earlier and
// stretches asynchronous tracks over the whole true track, here a track lives until its last observation.

/// One track and its errors.
struct TrackErrors {
  std::int64_t id = 0;
  TimeNs start = 0;               ///< first observation
  std::int64_t observations = 0;  ///< with and without truth
  double lifetime_s = 0.0;        ///< last observation minus the first
  TrackVerdict verdict = TrackVerdict::kNoTruth;
  // The rest is for judged tracks.
  std::vector<double> ages_s;             ///< of the positions compared, since the first with a truth
  std::vector<double> errors_px;          ///< of the same
  double surface_error_px = 0.0;          ///< median error from the surface that it follows best
  std::optional<double> true_lifetime_s;  ///< how long the point is visible; empty if unknown
  std::vector<double> feature_ages_s;     ///< one for each threshold

  bool judged() const { return verdict == TrackVerdict::kJudged; }
};

/// All judged tracks at one threshold. NaN where there is nothing to average or a quantity is unknown.
struct ThresholdAccuracy {
  double threshold_px = 0.0;  ///< infinity: whole tracks
  Statistics error_px;        ///< over all positions within the feature ages
  double error_p25_px = 0.0;  ///< percentiles of the same
  double error_p75_px = 0.0;
  double error_p95_px = 0.0;
  double error_p99_px = 0.0;
  double track_error_mean_px = 0.0;     ///< mean over stable tracks of each one's mean error: "tracking error" of [2]
  double track_error_median_px = 0.0;   ///< median over stable tracks of each one's median error
  double exceeding_share = 0.0;         ///< tracks whose error exceeds the threshold at any time
  double mostly_exceeding_share = 0.0;  ///< tracks whose median error does, over the whole life
  double stray_share = 0.0;             ///< tracks that follow no surface
  double outlier_share = 0.0;           ///< tracks that are not stable: they exceed it at once
  Statistics feature_age_s;             ///< over stable tracks
  /// Mean feature age of stable tracks times their share, "expected feature age" of [2]: the same as the mean over all
  /// tracks, outliers with 0, which is the "feature age" of [1].
  double expected_age_s = 0.0;
  /// The same with each age as a share of the true lifetime: 1 for a tracker that never fails. Only over tracks with
  /// a known true lifetime above 0.
  double expected_age_normalized = 0.0;
};

/// Errors of positions of one age, for error over age.
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
  std::string truth;                          ///< where the truth comes from: tracks, depth or triangulated
  std::vector<double> thresholds_px;          ///< ascending
  std::vector<TrackErrors> tracks;            ///< in order of id
  std::vector<ThresholdAccuracy> thresholds;  ///< one for each threshold, then one of whole tracks
  double expected_age_normalized = 0.0;       ///< mean over the thresholds 1, 2, ..., 31 px, as in [2]; NaN if unknown
  std::vector<AgeBin> error_over_age;         ///< equal widths of 1, 2 or 5 times a power of ten; empty bins left out
};

/// Number of tracks with this verdict.
std::int64_t Count(const TrackAccuracy& accuracy, TrackVerdict verdict);

/// `truth` belongs to `tracks` one by one and comes from what `source` names; `thresholds_px` in any order.
/// Throws Error: kUsage for thresholds that are not positive, kNothingToDo where no track can be judged.
TrackAccuracy EvaluateTracks(const std::vector<FeatureTrack>& tracks, const std::vector<TrueTrack>& truth,
                             const std::string& source, std::vector<double> thresholds_px);

}  // namespace evo::evaluation
