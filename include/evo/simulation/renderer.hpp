#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/simulation/scene.hpp"

namespace evo {

/// Pixels x0 <= x < x0 + width, y0 <= y < y0 + height of the raw image.
struct Tile {
  int x0 = 0;
  int y0 = 0;
  int width = 0;
  int height = 0;
};

/// The sensor cut into tiles of at most `size` px, row by row.
std::vector<Tile> CutIntoTiles(int width, int height, int size);

/// Casts rays through the lens model of `camera` at the surfaces of `scene`; both must outlive it. Safe to call from
/// many threads at once.
class Renderer {
 public:
  /// Each pixel is the mean of samples x samples rays spread over its square around its centre.
  Renderer(const Scene& scene, const Camera& camera, int samples);

  /// Indices of the surfaces that any pixel of `tile` may see while the camera goes from one pose to the other during
  /// [from, to]: what Render and Depth need, to be found anew every few milliseconds of motion.
  struct Visible {
    std::vector<int> surfaces;
  };
  Visible FindVisible(const Tile& tile, TimeNs from, TimeNs to, const SE3& T_world_cam_from,
                      const SE3& T_world_cam_to) const;

  /// Radiance of the pixels of `tile` at time `t`, row by row, into `radiance` (width * height).
  void Render(const Tile& tile, const Visible& visible, TimeNs t, const SE3& T_world_cam,
              std::span<float> radiance) const;

  /// Depth (z in the camera frame, m) along the rays through the pixel centres, NaN where there is only sky.
  void Depth(const Tile& tile, const Visible& visible, TimeNs t, const SE3& T_world_cam, std::span<float> depth) const;

  /// Upper estimate of the speed, in px/s, of what `tile` shows between the two poses and times.
  double ImageSpeed(const Tile& tile, const Visible& visible, TimeNs from, TimeNs to, const SE3& T_world_cam_from,
                    const SE3& T_world_cam_to) const;
};

}  // namespace evo
