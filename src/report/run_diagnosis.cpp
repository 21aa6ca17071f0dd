#include "evo/report/run_diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evo::report {

namespace {

// What is out of the ordinary. docs/evaluation.md repeats these thresholds.
constexpr double kMinWantedRatio = 0.5;   // features in the median: the tracker fills up to the wanted number
constexpr std::size_t kMinFeatures = 20;  // a map starts from 15 that agree, and some are outliers
// At 7 m/s what is 50 m away rests within 43 px of the direction of travel: 6 % of a sensor of 346 x 260 pixels.
constexpr double kMaxRestRatio = 0.1;
constexpr double kMaxHotPixelRatio = 0.005;   // sensors have 0.05 to 0.5 % of hot pixels
constexpr double kMaxOtherEventsRatio = 0.2;  // by hot pixels or flicker: beyond it they hide edges of the scene
constexpr double kMaxMaskedRatio = 0.5;       // less than half of the view is left
constexpr double kMinCoverage = 0.97;         // a start takes some tenths of a second, 1 to 2 % of a short recording
constexpr double kMinForwardRatio = 0.8;      // a vehicle looks where it goes
constexpr double kMinDriveS = 10.0;           // a shorter drive is too short for its scale to drift
constexpr double kMinScaleCovered = 0.5;      // of the path
constexpr double kMaxPositionSigma = 0.01;    // of the path: good runs state 0.2 to 0.4 %
constexpr std::size_t kMaxListed = 3;         // restarts in a sentence

double Percent(double ratio) { return 100.0 * ratio; }

/// "at 2.10 s: lost at 1.90 s with 12 features, ..."
std::string DescribeRestart(TimeNs restart, const std::vector<LossDiagnosis>& losses) {
  const auto after =
      std::ranges::find_if(losses, [&](const LossDiagnosis& loss) { return loss.t > restart; }) - losses.begin();
  std::string text = fmt::format("at {} s", FormatTime(restart));
  if (after == 0) return text;
  const LossDiagnosis& loss = losses[static_cast<std::size_t>(after - 1)];
  return text + fmt::format(" (lost at {} s with {} features, {} of them in the map, {} of these agreed)",
                            FormatTime(loss.t), loss.features, loss.map_points, loss.inliers);
}

void WarnOfFilters(const FilterDiagnosis& seen, std::vector<std::string>* warnings) {
  if (seen.hot_pixel_ratio > kMaxHotPixelRatio) {
    warnings->push_back(fmt::format(
        "{} pixels are hot, {:.2f} % of the sensor; above {:.1f} % the sensor is worn or warm, or something "
        "in the scene flickers",
        seen.hot_pixels, Percent(seen.hot_pixel_ratio), Percent(kMaxHotPixelRatio)));
  }
  if (seen.hot_event_ratio > kMaxOtherEventsRatio) {
    warnings->push_back(fmt::format("hot pixels made {:.0f} % of the events", Percent(seen.hot_event_ratio)));
  }
  if (seen.flicker_event_ratio > kMaxOtherEventsRatio) {
    warnings->push_back(
        fmt::format("lamps that flicker at {:.1f} Hz made {:.0f} % of the events; edges in their light "
                    "may be lost",
                    seen.flicker_hz, Percent(seen.flicker_event_ratio)));
  }
  if (seen.masked_pixel_ratio > kMaxMaskedRatio) {
    warnings->push_back(fmt::format("the mask covers {:.0f} % of the sensor; is black what is to be ignored?",
                                    Percent(seen.masked_pixel_ratio)));
  }
}

void WarnOfFeatures(const FeatureDiagnosis& seen, std::vector<std::string>* warnings) {
  if (seen.at_rest.observations == 0) {
    warnings->emplace_back("nothing was tracked: the events show no corner that moves long enough");
    return;
  }
  if (seen.median < kMinWantedRatio * seen.wanted) {
    warnings->push_back(fmt::format(
        "only {:.0f} of {} wanted features were live in the median: little texture or motion, or much noise",
        seen.median, seen.wanted));
  }
  if (seen.min_at && seen.min < kMinFeatures) {
    warnings->push_back(fmt::format("only {} features were live at {} s: the pose is uncertain there or lost", seen.min,
                                    FormatTime(*seen.min_at)));
  }
  if (seen.at_rest.moving_ratio > kMaxRestRatio) {
    warnings->push_back(
        fmt::format("{:.1f} % of the observations are by features that rest while the scene moves: noise, or something "
                    "fixed to the camera that --mask should cover",
                    Percent(seen.at_rest.moving_ratio)));
  }
}

void WarnOfRestarts(const TrajectoryDiagnosis& seen, std::vector<std::string>* warnings) {
  if (seen.restarts.empty()) return;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMaxListed, seen.restarts.size()); ++i) {
    text += (i > 0 ? ", " : "") + DescribeRestart(seen.restarts[i], seen.losses);
  }
  if (seen.restarts.size() > kMaxListed) text += ", ...";
  const std::size_t count = seen.restarts.size();
  warnings->push_back(fmt::format("the map was started anew {}, where place and scale may jump: {}",
                                  count == 1 ? "once" : fmt::format("{} times", count), text));
}

void WarnOfTrajectory(const TrajectoryDiagnosis& seen, std::vector<std::string>* warnings) {
  if (seen.coverage < kMinCoverage) {
    warnings->push_back(fmt::format("only {:.1f} % of the frames have a pose", Percent(seen.coverage)));
  }
  WarnOfRestarts(seen, warnings);
  const bool is_drive = seen.forward_ratio > kMinForwardRatio && seen.duration_s >= kMinDriveS;
  if (is_drive && !seen.scale_is_held) {
    warnings->emplace_back("this looks like a drive, and no ground holds its scale, which may drift");
  } else if (is_drive && seen.scale_covered_ratio < kMinScaleCovered) {
    warnings->push_back(fmt::format("the ground holds the scale within a percent along {:.0f} % of the path only",
                                    Percent(seen.scale_covered_ratio)));
  }
  if (seen.position_sigma_ratio.value_or(0.0) > kMaxPositionSigma) {
    warnings->push_back(fmt::format("the last position is uncertain by {:.1f} % of the path (standard deviation)",
                                    Percent(*seen.position_sigma_ratio)));
  }
}

/// To four decimals, so that the order of a sum does not show.
double Rounded(double ratio) { return std::round(1e4 * ratio) / 1e4; }

}  // namespace

std::vector<std::pair<std::string, double>> DiagnosisValues(const RunDiagnosis& diagnosis) {
  std::vector<std::pair<std::string, double>> values;
  const auto add_ratio = [&](const char* name, double ratio) { values.emplace_back(name, Rounded(ratio)); };
  if (const auto& seen = diagnosis.filters) {
    add_ratio("hot_pixel_ratio", seen->hot_pixel_ratio);
    add_ratio("hot_event_ratio", seen->hot_event_ratio);
    add_ratio("masked_pixel_ratio", seen->masked_pixel_ratio);
    add_ratio("masked_event_ratio", seen->masked_event_ratio);
    values.emplace_back("flicker_hz", std::round(10.0 * seen->flicker_hz) / 10.0);
    add_ratio("flicker_event_ratio", seen->flicker_event_ratio);
  }
  if (const auto& seen = diagnosis.features) {
    values.emplace_back("live_features_median", seen->median);
    if (seen->min_at) values.emplace_back("live_features_min", static_cast<double>(seen->min));
    add_ratio("at_rest_ratio", seen->at_rest.ratio);
    add_ratio("at_rest_moving_ratio", seen->at_rest.moving_ratio);
  }
  if (const auto& seen = diagnosis.trajectory) {
    add_ratio("coverage", seen->coverage);
    values.emplace_back("restarts", static_cast<double>(seen->restarts.size()));
    values.emplace_back("scale_held", seen->scale_is_held ? 1.0 : 0.0);
    add_ratio("scale_covered_ratio", seen->scale_covered_ratio);
    add_ratio("forward_ratio", seen->forward_ratio);
    if (seen->position_sigma_ratio) add_ratio("position_sigma_ratio", *seen->position_sigma_ratio);
  }
  return values;
}

std::vector<std::string> DiagnosisWarnings(const RunDiagnosis& diagnosis) {
  std::vector<std::string> warnings;
  if (diagnosis.filters) WarnOfFilters(*diagnosis.filters, &warnings);
  if (diagnosis.features) WarnOfFeatures(*diagnosis.features, &warnings);
  if (diagnosis.trajectory) WarnOfTrajectory(*diagnosis.trajectory, &warnings);
  return warnings;
}

std::string FormatFeatures(const FeatureDiagnosis& features) {
  std::string text = fmt::format("features   {:.0f} live in the median", features.median);
  if (features.min_at) text += fmt::format(", {} at the least ({} s)", features.min, FormatTime(*features.min_at));
  return text + fmt::format("; {:.1f} % of the observations at rest, {:.1f} % while the scene moves\n",
                            Percent(features.at_rest.ratio), Percent(features.at_rest.moving_ratio));
}

std::string FormatTrajectory(const TrajectoryDiagnosis& trajectory) {
  std::string text = fmt::format("coverage   {:.1f} % of the frames", Percent(trajectory.coverage));
  if (trajectory.position_sigma_ratio) {
    text += fmt::format("; the last position is uncertain by {:.2f} % of the path (standard deviation)",
                        Percent(*trajectory.position_sigma_ratio));
  }
  return text + '\n';
}

std::string FormatWarnings(const RunDiagnosis& diagnosis) {
  std::string text;
  for (const auto& warning : DiagnosisWarnings(diagnosis)) text += "warning    " + warning + '\n';
  return text;
}

std::string DescribeDiagnosis(const RunDiagnosis& diagnosis) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (const auto& seen = diagnosis.features) {
    const std::string min = seen->min_at ? fmt::format("{} at the least, ", seen->min) : "";
    add(fmt::format("{:.0f} features live in the median, {}{:.1f} % of their observations at rest", seen->median, min,
                    Percent(seen->at_rest.ratio)));
  }
  if (const auto& seen = diagnosis.filters; seen && seen->hot_pixels > 0) {
    add(fmt::format("{} hot pixels with {:.1f} % of the events", seen->hot_pixels, Percent(seen->hot_event_ratio)));
  }
  if (const auto& seen = diagnosis.filters; seen && seen->flicker_event_ratio > 0.0) {
    add(fmt::format("flicker in {:.1f} % of the events", Percent(seen->flicker_event_ratio)));
  }
  if (const auto& seen = diagnosis.trajectory) {
    add(fmt::format("poses for {:.1f} % of the frames, {} restarts", Percent(seen->coverage), seen->restarts.size()));
  }
  for (const auto& warning : DiagnosisWarnings(diagnosis)) add(warning);
  return text;
}

}  // namespace evo::report
