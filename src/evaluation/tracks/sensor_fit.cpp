#include "evaluation/tracks/sensor_fit.hpp"

#include <fmt/format.h>

#include "evo/core/error.hpp"

namespace evo::evaluation {

namespace {

constexpr double kBorderPx = 1.0;        // trackers may place a feature slightly outside the border
constexpr double kMaxMisfitRatio = 0.2;  // a poor tracker's features leave the sensor too

}  // namespace

void CheckSensorFit(const std::vector<FeatureTrack>& tracks, const geometry::Camera& camera) {
  std::size_t misfits = 0;
  std::size_t all = 0;
  for (const auto& track : tracks) {
    for (const auto& observation : track.observations) {
      const Eigen::Vector2d pixel(observation.x, observation.y);
      misfits += camera.Contains(pixel, -kBorderPx) && camera.Undistort(pixel) ? 0 : 1;
      ++all;
    }
  }
  if (static_cast<double>(misfits) <= kMaxMisfitRatio * static_cast<double>(all)) return;
  throw Error(ErrorKind::kInput,
              fmt::format("{} of {} track positions lie off the calibrated {} x {} sensor or outside its lens model; "
                          "tracks and calibration do not belong together",
                          misfits, all, camera.width(), camera.height()));
}

}  // namespace evo::evaluation
