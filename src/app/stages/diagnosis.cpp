#include "app/stages/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "evo/core/median.hpp"

namespace evo::app {

namespace {

constexpr TimeNs kStart = 500'000'000;  // ns: the longest window of events several times over

double Ratio(std::uint64_t part, std::uint64_t all) {
  return static_cast<double>(part) / static_cast<double>(std::max<std::uint64_t>(1, all));
}

/// Part of the path on which the camera moves within 45 degrees of its optical axis.
double ForwardRatio(const geometry::Trajectory& trajectory) {
  double forward = 0.0;
  double path = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const geometry::SE3& T_world_cam = trajectory[i - 1].T_world_cam;
    const Eigen::Vector3d step = T_world_cam.Inverse() * trajectory[i].T_world_cam.translation();
    path += step.norm();
    if (step.z() > std::sqrt(0.5) * step.norm()) forward += step.norm();
  }
  return path > 0.0 ? forward / path : 0.0;
}

}  // namespace

report::FilterDiagnosis DiagnoseFilters(const events::FilterStatistics& filters, std::size_t hot_pixels,
                                        const geometry::Camera& camera) {
  const auto pixels = static_cast<std::uint64_t>(camera.width()) * static_cast<std::uint64_t>(camera.height());
  report::FilterDiagnosis diagnosis;
  diagnosis.hot_pixels = hot_pixels;
  diagnosis.hot_pixel_ratio = Ratio(hot_pixels, pixels);
  diagnosis.hot_event_ratio = Ratio(filters.hot_events, filters.events);
  diagnosis.masked_pixel_ratio = Ratio(filters.masked_pixels, pixels);
  diagnosis.masked_event_ratio = Ratio(filters.masked_events, filters.events);
  diagnosis.flicker_hz = filters.flicker.frequency_hz;
  diagnosis.flicker_event_ratio = Ratio(filters.flicker.flicker_events, filters.events);
  return diagnosis;
}

report::FeatureDiagnosis DiagnoseFeatures(const tracking::TrackerOptions& options,
                                          std::span<const report::LiveFeatures> live,
                                          const evaluation::RestStatistics& at_rest) {
  report::FeatureDiagnosis diagnosis;
  diagnosis.wanted = options.features;
  diagnosis.at_rest = at_rest;
  std::vector<double> counts;
  for (const auto& frame : live) {
    counts.push_back(static_cast<double>(frame.features));
    if (frame.t < live.front().t + kStart) continue;
    const auto features = static_cast<std::size_t>(frame.features);
    if (diagnosis.min_at && features >= diagnosis.min) continue;
    diagnosis.min = features;
    diagnosis.min_at = frame.t;
  }
  diagnosis.median = Median(std::move(counts));
  return diagnosis;
}

report::TrajectoryDiagnosis DiagnoseTrajectory(const odometry::OdometryResult& result) {
  report::TrajectoryDiagnosis diagnosis;
  const geometry::Trajectory& trajectory = result.trajectory;
  if (result.frames > 0) diagnosis.coverage = Ratio(trajectory.size(), static_cast<std::uint64_t>(result.frames));
  if (!result.bootstraps.empty()) diagnosis.restarts.assign(result.bootstraps.begin() + 1, result.bootstraps.end());
  for (const auto& loss : result.losses) {
    diagnosis.losses.push_back({loss.t, loss.features, loss.map_points, loss.inliers});
  }
  diagnosis.scale_is_held = result.ground && result.ground->found;
  if (diagnosis.scale_is_held) diagnosis.scale_covered_ratio = result.ground->covered_ratio;
  diagnosis.forward_ratio = ForwardRatio(trajectory);
  if (!trajectory.empty()) diagnosis.duration_s = ToSeconds(trajectory.back().t - trajectory.front().t);
  const double path = geometry::PathLength(trajectory);
  // Covariances start anew with each segment.
  if (!result.covariances.empty() && diagnosis.restarts.empty() && path > 0.0) {
    const auto position = result.covariances.back().covariance.topLeftCorner<3, 3>();
    diagnosis.position_sigma_ratio = std::sqrt(position.trace()) / path;
  }
  return diagnosis;
}

}  // namespace evo::app
