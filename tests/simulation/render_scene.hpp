#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "evo/core/random.hpp"
#include "evo/geometry/known_cameras.hpp"
#include "simulation/render/renderer.hpp"

namespace evo::simulation {

inline geometry::Camera Davis346() { return geometry::Camera(geometry::MvsecDavis346()); }
inline geometry::Camera Davis240() { return geometry::Camera(geometry::UzhDavis240c()); }

inline Texture Plain(float reflectance, float coverage = 1.0F) {
  return Texture(1, 1, {{.reflectance = reflectance, .coverage = coverage}});
}

/// A scene of the static world alone with one grey texture.
inline Scene Empty() {
  Scene scene;
  scene.textures.push_back(Plain(0.5F));
  scene.bodies.resize(1);
  return scene;
}

/// Level ground 1.5 m below the camera.
inline Surface LevelGround() {
  Surface ground;
  ground.origin = {-200, 1.5, -10};
  ground.edge_u = {400, 0, 0};
  ground.edge_v = {0, 0, 400};
  return ground;
}

/// A rectangle that faces the camera at depth z.
inline Surface Facing(double x0, double x1, double y0, double y1, double z, int texture = 0) {
  Surface surface;
  surface.origin = {x0, y0, z};
  surface.edge_u = {x1 - x0, 0, 0};
  surface.edge_v = {0, y1 - y0, 0};
  surface.texture = texture;
  return surface;
}

inline Eigen::Vector3d RandomVector(Random* random, double size) {
  const double x = random->Uniform(-size, size);
  const double y = random->Uniform(-size, size);
  return {x, y, random->Uniform(-size, size)};
}

/// Parallelograms of all sizes all round the camera, a third of them on two moving bodies.
inline Scene RandomScene(int surfaces, std::uint64_t seed) {
  Random random(seed);
  Scene scene = Empty();
  for (int i = 1; i <= 2; ++i) {
    const Eigen::Vector3d start = RandomVector(&random, 10.0);
    const Eigen::Vector3d speed = RandomVector(&random, 5.0);
    const Eigen::Vector3d spin = RandomVector(&random, 1.0);
    scene.bodies.push_back({.T_world_body = [=](TimeNs t) {
      return geometry::SE3(geometry::so3::Exp(spin * ToSeconds(t)), start + speed * ToSeconds(t));
    }});
  }
  for (int i = 0; i < surfaces; ++i) {
    Surface surface;
    surface.origin = RandomVector(&random, 20.0);
    const double size = std::exp(random.Uniform(-1.5, 2.5));
    surface.edge_u = RandomVector(&random, size);
    surface.edge_v = RandomVector(&random, size);
    surface.body = random.Chance(0.33) ? 1 + random.Index(2) : 0;
    if (surface.body > 0) surface.origin *= 0.3;
    scene.surfaces.push_back(surface);
  }
  return scene;
}

inline Renderer::VisibleSet All(const Scene& scene) {
  Renderer::VisibleSet all;
  for (int i = 0; i < static_cast<int>(scene.surfaces.size()); ++i) all.surfaces.push_back(i);
  return all;
}

inline Tile WholeImage(const geometry::Camera& camera) { return {0, 0, camera.width(), camera.height()}; }

inline std::vector<float> RenderAll(const Scene& scene, const geometry::Camera& camera, int samples, TimeNs t = 0,
                                    const geometry::SE3& T_world_cam = geometry::SE3()) {
  Renderer::Radiance radiance;
  Renderer(scene, camera, samples).Render(WholeImage(camera), All(scene), t, T_world_cam, &radiance);
  std::vector<float> image = radiance.steady;
  const double flicker = Flicker(scene.lighting, t);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] += static_cast<float>(flicker) * radiance.lamps[i];
  return image;
}

inline std::vector<float> DepthOfAll(const Scene& scene, const geometry::Camera& camera, TimeNs t = 0,
                                     const geometry::SE3& T_world_cam = geometry::SE3()) {
  std::vector<float> image(static_cast<std::size_t>(camera.width()) * static_cast<std::size_t>(camera.height()));
  std::vector<std::uint8_t> moving(image.size());
  Renderer(scene, camera, 1).RenderDepth(WholeImage(camera), All(scene), t, T_world_cam, image, moving);
  return image;
}

/// What the ray of a pixel's centre hits first, found one surface after the other in double precision.
struct Hit {
  int surface = -1;
  double depth = 0.0;
  double margin = 1.0;  ///< of a, b from the edges of the surfaces met: hits closer to an edge may differ by rounding
};
inline Hit CastRay(const Scene& scene, const Eigen::Vector2d& ray, TimeNs t, const geometry::SE3& T_world_cam) {
  Hit hit;
  for (int i = 0; i < static_cast<int>(scene.surfaces.size()); ++i) {
    const Surface& s = scene.surfaces[i];
    const geometry::SE3 T_cam_body = T_world_cam.Inverse() * BodyPose(scene, s.body, t);
    Eigen::Matrix3d system;
    system << ray.homogeneous(), -(T_cam_body.rotation() * s.edge_u), -(T_cam_body.rotation() * s.edge_v);
    const Eigen::Vector3d z_a_b = system.inverse() * (T_cam_body * s.origin);
    const double inside = std::min({z_a_b.y(), z_a_b.z(), 1.0 - z_a_b.y(), 1.0 - z_a_b.z()});
    if (z_a_b.x() <= 0.0) continue;
    hit.margin = std::min(hit.margin, std::abs(inside));
    if (inside < 0.0 || (hit.surface >= 0 && z_a_b.x() >= hit.depth)) continue;
    hit.surface = i;
    hit.depth = z_a_b.x();
  }
  return hit;
}

}  // namespace evo::simulation
