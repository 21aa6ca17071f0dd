#include "tracking/detection/motion_compensated_image.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "evo/core/bilinear.hpp"

namespace evo::tracking {

namespace {

constexpr std::size_t kStripes = 2;    // of the image, in parallel; the sum over more costs more than they save
constexpr double kMinSpeedPxS = 1e-3;  // guards a division

/// The flow within a tile: bilinear between the tile's corners.
struct TileFlow {
  Eigen::Array2f origin, along_x, along_y, along_xy;  // px/s, for x and y in tiles
  float min_speed;                                    // px/s, a lower bound of the flow in the tile

  TileFlow(const FlowField& field, double x, double y) {
    constexpr double kSide = events::EventHistory::kTilePx;
    const auto corner = [&](double dx, double dy) -> Eigen::Array2f {
      return field.Interpolate({x + dx * kSide, y + dy * kSide}).cast<float>();
    };
    origin = corner(0, 0);
    along_x = corner(1, 0) - origin;
    along_y = corner(0, 1) - origin;
    along_xy = corner(1, 1) - origin - along_x - along_y;
    const Eigen::Array2f centre = origin + 0.5f * (along_x + along_y) + 0.25f * along_xy;
    const Eigen::Array2f deviation = 0.5f * (along_x.abs() + along_y.abs()) + 0.25f * along_xy.abs();
    min_speed = centre.matrix().norm() - deviation.matrix().norm();
  }

  Eigen::Array2f Interpolate(float x, float y) const { return origin + x * along_x + y * (along_y + x * along_xy); }
};

/// Half of the window in which an edge moves by `motion_px`, within limits.
struct HalfWindowLimits {
  double motion_px, min_s, max_s;

  double HalfWindowS(double speed_px_s) const {
    return std::min(std::max(motion_px / std::max(speed_px_s, kMinSpeedPxS), min_s), max_s);
  }
};

/// Adds an event bilinearly to four pixels.
void Vote(float x, float y, cv::Mat* image) {
  if (!(x >= 0.0f && y >= 0.0f)) return;
  const BilinearCell<float> at(x, y);
  if (at.column + 1 >= image->cols || at.row + 1 >= image->rows) return;
  float* const upper = image->ptr<float>(at.row) + at.column;
  float* const lower = image->ptr<float>(at.row + 1) + at.column;
  upper[0] += (1 - at.fx) * (1 - at.fy);
  upper[1] += at.fx * (1 - at.fy);
  lower[0] += (1 - at.fx) * at.fy;
  lower[1] += at.fx * at.fy;
}

/// A tile of the sensor, by its number in each direction.
struct Tile {
  std::size_t row, column;
};

void AddTile(const events::EventHistory& history, const Tile& tile, TimeNs t, const FlowField& field,
             const HalfWindowLimits& limits, cv::Mat* image) {
  const int left = static_cast<int>(tile.column) * events::EventHistory::kTilePx;
  const int top = static_cast<int>(tile.row) * events::EventHistory::kTilePx;
  const TileFlow flow(field, left, top);
  // The slowest flow of a tile has its longest window. Each event is then tested against its own window, without a
  // square root and a division.
  const TimeNs max_half_window = FromSeconds(limits.HalfWindowS(flow.min_speed));
  const auto min_s = static_cast<float>(limits.min_s);
  const auto squared_motion = static_cast<float>(limits.motion_px * limits.motion_px);
  constexpr float kPerTile = 1.0f / events::EventHistory::kTilePx;
  const auto add = [&](int x, int y, TimeNs event_t, std::int8_t) {
    const Eigen::Array2f v =
        flow.Interpolate(kPerTile * static_cast<float>(x - left), kPerTile * static_cast<float>(y - top));
    const float dt = 1e-9f * static_cast<float>(event_t - t);
    const Eigen::Array2f motion = dt * v;
    if (std::abs(dt) > min_s && motion.matrix().squaredNorm() > squared_motion) return;
    Vote(static_cast<float>(x) - motion.x(), static_cast<float>(y) - motion.y(), image);
  };
  history.ForEachInTile(tile.row * history.tile_columns() + tile.column, t - max_half_window, t + max_half_window, add);
}

}  // namespace

cv::Mat MotionCompensatedImage(const events::EventHistory& history, TimeNs t, const FlowField& flow, double motion_px,
                               const TrackerOptions& options, ThreadPool* pool) {
  // Events leave their tile, so each stripe of tiles has its own image. The stripes do not depend on the pool's size,
  // which keeps the sums the same.
  std::array<cv::Mat, kStripes> stripes;
  const std::size_t rows = history.tile_rows();
  const HalfWindowLimits limits{0.5 * motion_px, 0.5 * options.min_window_s, 0.5 * options.max_window_s};
  pool->ForEach(kStripes, [&](std::size_t i) {
    stripes[i].create(history.height(), history.width(), CV_32F);
    stripes[i].setTo(0.0);
    for (std::size_t row = i * rows / kStripes; row < (i + 1) * rows / kStripes; ++row) {
      for (std::size_t column = 0; column < history.tile_columns(); ++column) {
        AddTile(history, {row, column}, t, flow, limits, &stripes[i]);
      }
    }
  });
  for (std::size_t i = 1; i < kStripes; ++i) stripes[0] += stripes[i];
  return stripes[0];
}

}  // namespace evo::tracking
