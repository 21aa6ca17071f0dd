#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/simulation/scene.hpp"
#include "evo/simulation/surface_tree.hpp"

namespace evo::simulation {

/// Pixels x0 <= x < x0 + width, y0 <= y < y0 + height of the raw image.
struct Tile {
  int x0 = 0;
  int y0 = 0;
  int width = 0;
  int height = 0;
};

/// The sensor cut into tiles of at most `size` px, row by row.
std::vector<Tile> CutIntoTiles(int width, int height, int size);

struct RayBlock;

/// Casts rays through the lens model of `camera` at the surfaces of `scene`; both must outlive it. Safe to call from
/// many threads at once. The result for a pixel does not depend on how the sensor is cut, but for rounding.
///
/// Light: radiance = reflectance * (ambient * shade + lamps) + emission, holes looked through. A lamp gives
/// intensity * cos(incidence) / distance^2 * Flicker(lighting, t), faded out smoothly where that would be below 5e-4.
/// The head lamps sit at the camera and give head_lamps * beam * cos(incidence) / distance^2 with beam = 1 / (1 + (x /
/// 0.35)^2 + (y / 0.15)^2)^2 on the plane z = 1. Only the side that faces a light is lit by it.
class Renderer {
 public:
  /// Each pixel is the mean of samples x samples rays spread over its square around its centre, in a rotated grid: no
  /// two share a row or a column, so that an edge that crosses a pixel changes it in samples^2 steps. From
  /// pixel to pixel the grid is shifted by less than such a step, so that an edge that runs along the pixels is at its
  /// place on average over them, not at the nearest step.
  /// Throws Error(kInput) where `samples` is not in [1, 16] or a surface names a texture or body that is not there.
  Renderer(const Scene& scene, const geometry::Camera& camera, int samples);

  /// Indices of the surfaces that any pixel of `tile` may see while the camera goes from one pose to the other during
  /// [from, to]: what Render and Depth need, to be found anew every few milliseconds of motion. On the way camera and
  /// bodies may stray from the screw between their two poses by up to a pixel.
  struct Visible {
    std::vector<int> surfaces;
  };
  Visible FindVisible(const Tile& tile, TimeNs from, TimeNs to, const geometry::SE3& T_world_cam_from,
                      const geometry::SE3& T_world_cam_to) const;

  /// Radiance of pixels (row by row) in two parts, so that lamps may flicker faster than scenes are rendered: at time t
  /// it is steady + Flicker(lighting, t) * lamps.
  struct Radiance {
    std::vector<float> steady;
    std::vector<float> lamps;  ///< by the street lamps
    bool lit = false;          ///< false: `lamps` is all 0
  };

  /// What the pixels of `tile` see with the camera and the bodies as at time `t`. 0 where the lens model has no ray.
  void Render(const Tile& tile, const Visible& visible, TimeNs t, const geometry::SE3& T_world_cam,
              Radiance* radiance) const;

  /// Depth (z in the camera frame, m) along the rays through the pixel centres of the nearest surface that covers half
  /// or more there, NaN where there is only sky or no ray; and 1 where it is of something that moves, else 0.
  void Depth(const Tile& tile, const Visible& visible, TimeNs t, const geometry::SE3& T_world_cam,
             std::span<float> depth, std::span<std::uint8_t> moving) const;

  /// Upper estimate of the mean speed, in px/s, of what `tile` shows between the two poses and times.
  double ImageSpeed(const Tile& tile, const Visible& visible, TimeNs from, TimeNs to,
                    const geometry::SE3& T_world_cam_from, const geometry::SE3& T_world_cam_to) const;

 private:
  /// Rays (x, y, 1) through the plane z = 1: those of a pixel one after the other, pixels row by row.
  struct Rays {
    int per_pixel = 1;
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> level;  ///< per pixel: log2 of the distance of two rays on the plane z = 1
  };

  Rays CastRays(int samples);
  RayBox Bounds(const Tile& tile) const;
  void Gather(const Rays& rays, const Tile& part, RayBlock* block) const;
  Eigen::Vector2d Centre(int x, int y) const;
  Eigen::Matrix2d PixelsPerStep(int x, int y) const;

  const Scene& scene_;
  const geometry::Camera& camera_;
  SurfaceTree tree_;
  std::vector<std::uint8_t> blind_;  ///< per pixel: a ray of it has no direction
  Rays samples_;
  Rays centres_;
};

}  // namespace evo::simulation
