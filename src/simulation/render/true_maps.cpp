#include "evo/simulation/true_maps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "evo/core/parallel.hpp"
#include "simulation/render/renderer.hpp"

namespace evo::simulation {

namespace {

constexpr int kTile = 32;  // px; with one ray a pixel, smaller tiles spend more time on finding visible surfaces

}  // namespace

DepthCamera::DepthCamera(const Scene& scene, const geometry::Camera& camera, ThreadPool* pool)
    : camera_(camera), renderer_(std::make_unique<const Renderer>(scene, camera, 1)), pool_(pool) {}

DepthCamera::~DepthCamera() = default;

events::DepthMap DepthCamera::Render(TimeNs t, const geometry::SE3& T_world_cam) const {
  const auto width = static_cast<std::size_t>(camera_.width());
  const std::size_t pixels = width * static_cast<std::size_t>(camera_.height());
  events::DepthMap map{camera_.width(), camera_.height(), std::vector<double>(pixels),
                       std::vector<std::uint8_t>(pixels)};
  const std::vector<Tile> tiles = CutIntoTiles(camera_.width(), camera_.height(), kTile);
  pool_->ForEach(tiles.size(), [&](std::size_t i) {
    const Tile& tile = tiles[i];
    std::vector<float> depth(tile.pixels());
    std::vector<std::uint8_t> moving(tile.pixels());
    const auto visible = renderer_->FindVisible(tile, t, t, T_world_cam, T_world_cam);
    renderer_->RenderDepth(tile, visible, t, T_world_cam, depth, moving);
    for (int row = 0; row < tile.height; ++row) {
      const auto from = static_cast<std::ptrdiff_t>(row) * tile.width;
      const auto to = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(tile.y0 + row) * width) + tile.x0;
      std::copy_n(depth.begin() + from, tile.width, map.depth.begin() + to);
      std::copy_n(moving.begin() + from, tile.width, map.moving.begin() + to);
    }
  });
  return map;
}

events::FlowMap StaticFlow(const geometry::Camera& camera, const events::DepthMap& depth,
                           const geometry::SE3& T_next_now) {
  const std::size_t pixels = depth.depth.size();
  events::FlowMap map{depth.width, depth.height,
                      std::vector<double>(2 * pixels, std::numeric_limits<double>::quiet_NaN())};
  for (std::size_t i = 0; i < pixels; ++i) {
    const int x = static_cast<int>(i) % depth.width;
    const int y = static_cast<int>(i) / depth.width;
    const auto ray = camera.Undistort({x, y});
    if (!ray || !std::isfinite(depth.depth[i])) continue;
    const Eigen::Vector3d point = T_next_now * (depth.depth[i] * ray->homogeneous());
    if (!(point.z() > 0.0)) continue;
    const Eigen::Vector2d pixel = camera.Project(point);
    map.flow[i] = pixel.x() - x;
    map.flow[pixels + i] = pixel.y() - y;
  }
  return map;
}

}  // namespace evo::simulation
