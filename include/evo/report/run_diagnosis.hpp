#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/evaluation/track_rest.hpp"

namespace evo::report {

/// What the filters found; ratios are of all pixels and of all events.
struct FilterDiagnosis {
  std::size_t hot_pixels = 0;
  double hot_pixel_ratio = 0.0;
  double hot_event_ratio = 0.0;
  double masked_pixel_ratio = 0.0;
  double masked_event_ratio = 0.0;
  double flicker_hz = 0.0;  ///< 0: none
  double flicker_event_ratio = 0.0;
};

/// The features of the tracker.
struct FeatureDiagnosis {
  int wanted = 0;                ///< parameter; 0: unknown
  double median = 0.0;           ///< live ones in a frame
  std::size_t min = 0;           ///< fewest in a frame after the start
  std::optional<TimeNs> min_at;  ///< stamp of this frame; empty: the recording is too short to tell
  evaluation::RestStatistics at_rest;
};

/// A frame at which the pose was lost.
struct LossDiagnosis {
  TimeNs t = 0;
  std::size_t features = 0;
  std::size_t map_points = 0;  ///< features that are in the map
  std::size_t inliers = 0;     ///< map points that agree with one pose
};

/// The trajectory of the odometry.
struct TrajectoryDiagnosis {
  double coverage = 0.0;              ///< frames with a pose over all frames
  std::vector<TimeNs> restarts;       ///< frames at which the map was started anew
  std::vector<LossDiagnosis> losses;  ///< in order of time
  bool scale_is_held = false;         ///< by the ground
  double scale_covered_ratio = 0.0;   ///< part of the path where the scale is known within a percent
  double forward_ratio = 0.0;         ///< part of the path along the optical axis, within 45 degrees
  double duration_s = 0.0;
  std::optional<double> position_sigma_ratio;  ///< of the end, over the path; empty after a restart
};

/// What was seen in a run, as far as it came.
struct RunDiagnosis {
  std::optional<FilterDiagnosis> filters;
  std::optional<FeatureDiagnosis> features;
  std::optional<TrajectoryDiagnosis> trajectory;
};

/// Names and values for the manifest; see docs/formats.md.
std::vector<std::pair<std::string, double>> DiagnosisValues(const RunDiagnosis& diagnosis);

/// A sentence for each thing that is out of the ordinary; docs/evaluation.md states the thresholds and their reasons.
std::vector<std::string> DiagnosisWarnings(const RunDiagnosis& diagnosis);

/// Lines of the summary: live features and those at rest.
std::string FormatFeatures(const FeatureDiagnosis& features);
/// Coverage, restarts and uncertainty.
std::string FormatTrajectory(const TrajectoryDiagnosis& trajectory);
/// A line for each warning.
std::string FormatWarnings(const RunDiagnosis& diagnosis);

/// What was seen, in one line: for the message of a run that fails.
std::string DescribeDiagnosis(const RunDiagnosis& diagnosis);

}  // namespace evo::report
