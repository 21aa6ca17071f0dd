#pragma once

#include <filesystem>
#include <string>

#include "evo/evaluation/track_accuracy.hpp"
#include "evo/report/gnuplot.hpp"

namespace evo::report {

/// track_quality.csv: columns `quantity,unit,threshold_px,age_low_s,age_high_s,value`. First how many tracks there are
/// and how many are judged, then the figures of ThresholdAccuracy for each threshold (whole tracks have an empty
/// threshold_px), then rows `error_over_age_*` for each age_low_s <= age < age_high_s. Throws Error (kOutput).
void WriteTrackQuality(const std::filesystem::path& path, const evaluation::TrackAccuracy& accuracy);

/// track_errors.csv: a row a track: `id`, `start` (s), `verdict` (judged, too_short, no_truth, no_depth,
/// moves, not_triangulated), `observations`, `lifetime_s`, `true_lifetime_s`, `compared` positions and the `mean`,
/// `median`, `rmse`, `max` of their error (px), `surface_error_px`, then for each threshold `age_Tpx_s`, the feature
/// age, and `outlier_Tpx`, 1 where it is 0. Cells of tracks that are not judged are empty. Throws Error (kOutput).
void WriteTrackErrors(const std::filesystem::path& path, const evaluation::TrackAccuracy& accuracy);

/// Median and quartiles of the error over the age of the tracks, with the number of tracks of that age.
Figure TrackErrorFigure(const std::string& name, const evaluation::TrackAccuracy& accuracy);

/// The summary for people: a few aligned lines that end with a newline.
std::string FormatTrackAccuracy(const evaluation::TrackAccuracy& accuracy);

}  // namespace evo::report
