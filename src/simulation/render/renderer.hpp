#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/camera.hpp"
#include "simulation/render/bounding_volume_hierarchy.hpp"
#include "simulation/render/tile.hpp"
#include "simulation/world/scene.hpp"

namespace evo::simulation {

struct RayPacket;

/// A ray caster through the lens model of `camera`. Scene and camera must outlive it. Const calls are safe from several
/// threads. The result for a pixel does not depend on the tiles, but for rounding.
///
/// Radiance = reflectance * (ambient * shade + lamps) + emission, composited through holes from front to back. A street
/// lamp gives intensity * cos(incidence) / distance^2 * Flicker(lighting, t), with a smooth fade below 5e-4. The head
/// lamps sit at the camera and give head_lamps * beam * cos(incidence) / distance^2 with
/// beam = 1 / (1 + (x / 0.35)^2 + (y / 0.15)^2)^2 on the plane z = 1. A light reaches only the side that faces it.
class Renderer {
 public:
  /// A pixel is the mean over its square of samples x samples rays in a rotated grid: no two rays share a row or a
  /// column, so that an edge that crosses a pixel changes it in samples^2 steps. A shift of the grid from pixel to
  /// pixel by less than such a step keeps edges along the pixels unbiased. Throws Error(kInput) for `samples` outside
  /// [1, 16] and for a surface with a texture or body that the scene does not have.
  Renderer(const Scene& scene, const geometry::Camera& camera, int samples);

  /// The potentially visible set: indices of the surfaces that a pixel of a tile may see during a motion.
  struct VisibleSet {
    std::vector<int> surfaces;
  };
  /// For the motion from one pose to the other during [from, to]. Camera and bodies may deviate from the screw between
  /// their two poses by up to a pixel.
  VisibleSet FindVisible(const Tile& tile, TimeNs from, TimeNs to, const geometry::SE3& T_world_cam_from,
                         const geometry::SE3& T_world_cam_to) const;

  /// Radiance of pixels (row by row) in two parts, so that lamps may flicker faster than scenes are rendered: at time t
  /// it is steady + Flicker(lighting, t) * lamps.
  struct Radiance {
    std::vector<float> steady;
    std::vector<float> lamps;  ///< by the street lamps
    bool has_lamps = false;    ///< false: `lamps` is all 0
  };

  /// Radiance of the tile's pixels with the camera and the bodies as at `t`. 0 where the lens model has no ray.
  void Render(const Tile& tile, const VisibleSet& visible, TimeNs t, const geometry::SE3& T_world_cam,
              Radiance* radiance) const;

  /// Depth (z in the camera frame, m) along the rays through the pixel centres to the nearest surface with a coverage
  /// of at least 0.5, NaN for sky and for pixels without a ray; `moving` is 1 for a surface of a moving body, else 0.
  void RenderDepth(const Tile& tile, const VisibleSet& visible, TimeNs t, const geometry::SE3& T_world_cam,
                   std::span<float> depth, std::span<std::uint8_t> moving) const;

  /// Upper estimate of the image speed (px/s) in the tile between the two poses and times.
  double ImageSpeed(const Tile& tile, const VisibleSet& visible, TimeNs from, TimeNs to,
                    const geometry::SE3& T_world_cam_from, const geometry::SE3& T_world_cam_to) const;

 private:
  /// Rays (x, y, 1): those of a pixel one after the other, pixels row by row.
  struct Rays {
    int per_pixel = 1;
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> log2_spacing;  ///< per pixel: log2 of the distance of two rays on the plane z = 1
    std::vector<float> reflectivity;  ///< of the bonnet that mirrors a ray, 0: none does; empty: there is no bonnet
  };

  Rays CastRays(int samples);
  void AddRay(const Eigen::Vector2d& ray, Rays* rays) const;
  /// The mean of a pixel's rays, given the radiance that each would see without the bonnet.
  float PixelRadiance(int pixel, const float* radiance, float bonnet_radiance) const;
  RayFrustum TileFrustum(const Tile& tile) const;
  void GatherRays(const Rays& rays, const Tile& part, RayPacket* packet) const;
  Eigen::Vector2d CentreRay(int x, int y) const;
  Eigen::Matrix2d J_pixel_normalized(int x, int y) const;

  const Scene& scene_;
  const geometry::Camera& camera_;
  BoundingVolumeHierarchy hierarchy_;
  std::vector<std::uint8_t> has_no_ray_;  ///< per pixel: the lens model has no ray for part of it
  Rays samples_;
  Rays centres_;
  float max_spacing_ = 0.0F;  ///< of two neighbouring pixels on the plane z = 1
};

}  // namespace evo::simulation
