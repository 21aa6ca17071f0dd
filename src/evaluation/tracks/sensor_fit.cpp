#include "evaluation/tracks/sensor_fit.hpp"

#include <string>

#include "evo/core/error.hpp"

namespace evo::evaluation {

namespace {

constexpr double kOffSensorPx = 1.0;  // trackers may place a border feature a little outside
constexpr double kMisfitShare = 0.2;  // a poor tracker's features leave the sensor too

}  // namespace

void CheckSensorFit(const std::vector<FeatureTrack>& tracks, const geometry::Camera& camera) {
  std::size_t misfits = 0;
  std::size_t all = 0;
  for (const auto& track : tracks) {
    for (const auto& observation : track.observations) {
      const Eigen::Vector2d pixel(observation.x, observation.y);
      misfits += camera.Contains(pixel, -kOffSensorPx) && camera.Undistort(pixel) ? 0 : 1;
      ++all;
    }
  }
  if (static_cast<double>(misfits) <= kMisfitShare * static_cast<double>(all)) return;
  throw Error(ErrorKind::kInput, std::to_string(misfits) + " of " + std::to_string(all) +
                                     " track positions lie off the calibrated " + std::to_string(camera.width()) +
                                     " x " + std::to_string(camera.height()) +
                                     " sensor or outside its lens model; tracks and calibration do not belong "
                                     "together");
}

}  // namespace evo::evaluation
