#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "evo/core/error.hpp"
#include "evo/evaluation/track_rest.hpp"
#include "evo/events/filtered_event_reader.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/odometry/odometry_result.hpp"
#include "evo/report/figures.hpp"
#include "evo/report/run_diagnosis.hpp"
#include "evo/tracking/tracker_options.hpp"

namespace evo::app {

report::FilterDiagnosis DiagnoseFilters(const events::FilterStatistics& filters, std::size_t hot_pixels,
                                        const geometry::Camera& camera);

/// `live` are all event frames; the first half second, in which features gather their events, does not count for the
/// minimum.
report::FeatureDiagnosis DiagnoseFeatures(const tracking::TrackerOptions& options,
                                          std::span<const report::LiveFeatures> live,
                                          const evaluation::RestStatistics& at_rest);

report::TrajectoryDiagnosis DiagnoseTrajectory(const odometry::OdometryResult& result);

/// Calls `work` and returns its result; an Error that says that the data do not suffice also says what was seen.
template <typename Work>
auto WithErrorDiagnosis(const report::RunDiagnosis& diagnosis, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    const bool is_of_data = error.kind() == ErrorKind::kTrackingLost || error.kind() == ErrorKind::kDegenerateAlignment;
    const std::string seen = report::DescribeDiagnosis(diagnosis);
    if (!is_of_data || seen.empty()) throw;
    throw Error(error.kind(), std::string(error.what()) + "; seen: " + seen);
  }
}

}  // namespace evo::app
