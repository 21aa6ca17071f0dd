#pragma once

#include <filesystem>

#include "evo/evaluation/track_accuracy.hpp"

namespace evo::report {

/// track_quality.csv with the columns `quantity,unit,threshold_px,age_low_s,age_high_s,value`. First the numbers of
/// tracks by status, then ThresholdAccuracy for each threshold (an empty threshold_px means whole tracks), then rows
/// `error_over_age_*` for each age in [age_low_s, age_high_s). Throws Error (kOutput).
void WriteTrackQuality(const std::filesystem::path& path, const evaluation::TrackAccuracy& accuracy);

/// track_errors.csv with one row a track: `id`, `start` (s), `verdict` (judged, too_short, no_truth, no_depth, moves,
/// not_triangulated), `observations`, `lifetime_s`, `true_lifetime_s`, the number of `compared` positions and the
/// `mean`, `median`, `rmse`, `max` of their error (px), `surface_error_px`, then for each threshold `age_Tpx_s`, the
/// feature age, and `outlier_Tpx`, 1 for outliers. Cells of tracks that are not evaluated are empty. Throws Error
/// (kOutput).
void WriteTrackErrors(const std::filesystem::path& path, const evaluation::TrackAccuracy& accuracy);

}  // namespace evo::report
