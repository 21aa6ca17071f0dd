#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/se3.hpp"
#include "evo/simulation/texture.hpp"

namespace evo::simulation {

// The simulated world, in metres. World frame as in MVSEC's truth: that of the camera at the start of the run, x right,
// y down, z forward, so that "up" is -y and a level road lies at y = height of the camera. Textures are looked up from
// surfaces that all are parallelograms: streets, houses, cars and boxes need no more, and trees are made of some with
// holes.

/// The points origin + a * edge_u + b * edge_v for a, b in [0, 1]. Seen from both sides.
struct Surface {
  Eigen::Vector3d origin;
  Eigen::Vector3d edge_u;
  Eigen::Vector3d edge_v;
  int texture = 0;                                         ///< index in Scene::textures
  Eigen::Vector2d texel_origin = Eigen::Vector2d::Zero();  ///< texture coordinates (u, v) at a = b = 0
  Eigen::Vector2d texels = Eigen::Vector2d::Ones();        ///< texels from a = 0 to 1 and from b = 0 to 1
  float shade = 1.0F;                                      ///< light that falls on it by its orientation, 1 in full sun
  float emission = 0.0F;                                   ///< radiance of its own on top (lit windows, lamps)
  int body = 0;                                            ///< index in Scene::bodies of what it moves with
};

/// Something rigid that moves. Body 0 of a scene is the static world (identity).
struct Body {
  std::function<geometry::SE3(TimeNs)> T_world_body;  ///< time since the start of the run
};

/// A street lamp: light that falls off with the square of the distance and flickers with the mains, all in step.
struct Lamp {
  Eigen::Vector3d position;
  double intensity = 0.0;  ///< radiance of a white surface that faces it at 1 m
};

struct Lighting {
  double ambient = 1.0;        ///< radiance of a white surface of shade 1, everywhere: 1 by day, near 0 by night
  double sky = 2.0;            ///< radiance of what no surface covers
  double head_lamps = 0.0;     ///< radiance of a white surface 1 m ahead of the camera in the beam's middle; 0: off
  double flicker_hz = 120.0;   ///< of `lamps`
  double flicker_depth = 0.5;  ///< relative amplitude of it, in [0, 1)
  std::vector<Lamp> lamps;     ///< street lamps
};

/// Light of the street lamps at `t` relative to its mean: 1 + depth sin(2 pi f t).
double Flicker(const Lighting& lighting, TimeNs t);

struct Scene {
  std::vector<Texture> textures;
  std::vector<Surface> surfaces;
  std::vector<Body> bodies;  ///< at least the static world
  Lighting lighting;
};

/// Where the camera is at a time since the start of the run: T_world_cam, smooth and the same for equal arguments.
using CameraMotion = std::function<geometry::SE3(TimeNs)>;

}  // namespace evo::simulation
