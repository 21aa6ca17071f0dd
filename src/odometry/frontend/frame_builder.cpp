#include "odometry/frontend/frame_builder.hpp"

#include <fmt/format.h>

#include <optional>

#include "evo/core/error.hpp"

namespace evo::odometry {

namespace {

constexpr double kOffSensorPx = 1.0;      // trackers may place a border feature a little outside
constexpr double kMaxMisfitRatio = 0.02;  // more observations outside the lens model: the calibration is another one's

/// Jacobian of the raw pixel by `x` on the normalized plane z = 1, by central differences.
Eigen::Matrix2d PixelJacobian(const geometry::Camera& camera, const Eigen::Vector2d& x) {
  constexpr double kStep = 1e-4;  // normalized, some 0.02 px: far above rounding, far below the lens's curvature
  Eigen::Matrix2d J_pixel_normalized;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d d = kStep * Eigen::Vector2d::Unit(i);
    J_pixel_normalized.col(i) = (camera.Distort(x + d) - camera.Distort(x - d)) / (2.0 * kStep);
  }
  return J_pixel_normalized;
}

}  // namespace

std::vector<Frame> BuildFrames(const events::Tracks& tracks, const geometry::Camera& camera) {
  std::vector<Frame> frames;
  std::size_t misfits = 0;
  for (const auto& observation : tracks) {
    if (frames.empty() || frames.back().t != observation.t) frames.push_back({observation.t, {}, {}});
    auto& features = frames.back().features;
    if (!features.empty() && features.back().track == observation.id) continue;  // a duplicate
    const Eigen::Vector2d pixel(observation.x, observation.y);
    const auto x = camera.Contains(pixel, -kOffSensorPx) ? camera.Undistort(pixel) : std::nullopt;
    if (x) {
      features.push_back({observation.id, *x, PixelJacobian(camera, *x)});
    } else {
      ++misfits;
    }
  }
  if (static_cast<double>(misfits) > kMaxMisfitRatio * static_cast<double>(tracks.size())) {
    throw Error(ErrorKind::kInput,
                fmt::format("{} of {} track positions lie off the calibrated {} x {} sensor or outside its lens model; "
                            "tracks and calibration do not belong together",
                            misfits, tracks.size(), camera.width(), camera.height()));
  }
  return frames;
}

}  // namespace evo::odometry
