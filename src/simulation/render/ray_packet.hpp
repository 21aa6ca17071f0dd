#pragma once

#include <array>
#include <vector>

#include "simulation/render/bounding_volume_hierarchy.hpp"
#include "simulation/render/projected_surface.hpp"

namespace evo::simulation {

/// Neighbouring rays that are traced together (I. Wald et al., Interactive Rendering with Coherent Ray Tracing,
/// Eurographics 2001).
struct RayPacket {
  static constexpr int kSize = 256;  // few enough for the first-level cache, many enough for vector code

  int count = 0;
  std::array<float, kSize> x, y;
  std::array<float, kSize> log2_spacing;       ///< log2 of the distance of neighbouring rays on the plane z = 1
  std::array<float, kSize> max_inverse_depth;  ///< hits must have a smaller one: they lie behind the last hit
  std::array<float, kSize> transmittance;      ///< ratio of the light that passes the hits so far
  std::array<int, kSize> ray;                  ///< index of the ray in the packet as it was at first
  std::array<float, kSize> inverse_depth;      ///< of the nearest hit
  std::array<int, kSize> hit;                  ///< index of the surface that is hit, -1: none

  RayFrustum Frustum() const;
  /// Fills in `inverse_depth` and `hit`.
  void FindNearestHits(const std::vector<const ProjectedSurface*>& surfaces);
  /// Moves ray `from` to place `to`, where it continues behind its hit, which lets `transmittance_of_hit` pass.
  void ContinueBehind(int from, int to, float transmittance_of_hit);
};

/// Those surfaces that rays of the frustum may hit and that no solid surface in front occludes.
std::vector<const ProjectedSurface*> CullOccluded(const std::vector<ProjectedSurface>& surfaces,
                                                  const RayFrustum& rays);

/// Traces the rays through the holes of what they hit, from front to back. `shade(i, surface)` handles the hit of ray i
/// on `surfaces[surface]`, or the sky (-1), and returns the hit's transmittance. A ray ends at a transmittance of
/// 1/256, the step of a grey image.
template <typename Shader>
void TraceThroughHoles(const std::vector<const ProjectedSurface*>& surfaces, RayPacket* packet, const Shader& shade) {
  constexpr float kMinTransmittance = 1.0F / 256.0F;
  while (packet->count > 0) {
    packet->FindNearestHits(surfaces);
    int kept = 0;
    for (int i = 0; i < packet->count; ++i) {
      const float transmittance = shade(i, packet->hit[i]);
      if (packet->hit[i] >= 0 && transmittance * packet->transmittance[i] > kMinTransmittance) {
        packet->ContinueBehind(i, kept++, transmittance);
      }
    }
    packet->count = kept;
  }
}

}  // namespace evo::simulation
