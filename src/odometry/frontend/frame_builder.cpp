#include "odometry/frontend/frame_builder.hpp"

#include <optional>
#include <string>

#include "evo/core/error.hpp"

namespace evo::odometry {

namespace {

constexpr double kOffSensorPx = 1.0;   // trackers may place a border feature a little outside
constexpr double kMisfitShare = 0.02;  // of sightings that a calibration may fail to explain

/// The lens's Jacobian at `x` on the plane z = 1, by central differences.
Eigen::Matrix2d PxPerUnit(const geometry::Camera& camera, const Eigen::Vector2d& x) {
  constexpr double kStep = 1e-4;
  Eigen::Matrix2d jacobian;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d d = kStep * Eigen::Vector2d::Unit(i);
    jacobian.col(i) = (camera.Distort(x + d) - camera.Distort(x - d)) / (2.0 * kStep);
  }
  return jacobian;
}

}  // namespace

std::vector<Frame> BuildFrames(const events::Tracks& tracks, const geometry::Camera& camera) {
  std::vector<Frame> frames;
  std::size_t misfits = 0;
  for (const auto& sighting : tracks) {
    if (frames.empty() || frames.back().t != sighting.t) frames.push_back({sighting.t, {}, {}});
    auto& features = frames.back().features;
    if (!features.empty() && features.back().track == sighting.id) continue;  // the same sighting twice
    const Eigen::Vector2d pixel(sighting.x, sighting.y);
    const auto x = camera.Contains(pixel, -kOffSensorPx) ? camera.Undistort(pixel) : std::nullopt;
    if (x) {
      features.push_back({sighting.id, *x, PxPerUnit(camera, *x)});
    } else {
      ++misfits;
    }
  }
  if (static_cast<double>(misfits) > kMisfitShare * static_cast<double>(tracks.size())) {
    throw Error(ErrorKind::kInput, std::to_string(misfits) + " of " + std::to_string(tracks.size()) +
                                       " track positions lie off the calibrated " + std::to_string(camera.width()) +
                                       " x " + std::to_string(camera.height()) +
                                       " sensor or outside its lens model; tracks and calibration do not belong "
                                       "together");
  }
  return frames;
}

}  // namespace evo::odometry
