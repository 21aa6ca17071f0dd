#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/se3.hpp"
#include "evo/simulation/pose_function.hpp"
#include "simulation/world/texture.hpp"

namespace evo::simulation {

// The simulated world, in metres. The world frame is the camera frame at the start of the run, as in MVSEC's ground
// truth: x right, y down, z forward. A level road lies at y = height of the camera. All surfaces are textured
// parallelograms; trees consist of some with holes.

/// The points origin + a * edge_u + b * edge_v for a, b in [0, 1], visible from both sides. Coordinates are those of
/// the surface's body.
struct Surface {
  Eigen::Vector3d origin;
  Eigen::Vector3d edge_u;
  Eigen::Vector3d edge_v;
  int texture = 0;                                         ///< index in Scene::textures
  Eigen::Vector2d texel_origin = Eigen::Vector2d::Zero();  ///< texture coordinates (u, v) at a = b = 0
  Eigen::Vector2d texels = Eigen::Vector2d::Ones();        ///< texels along a and along b
  float shade = 1.0F;                                      ///< diffuse shading of the ambient light, 1 in full sun
  float emission = 0.0F;                                   ///< emitted radiance (lit windows, lamps)
  int body = 0;                                            ///< index in Scene::bodies
};

/// A rigid body. Body 0 of a scene is the static world (identity).
struct Body {
  PoseFunction T_world_body;
};

/// A street lamp. Its light falls off with the square of the distance; all lamps flicker in phase with the mains.
struct Lamp {
  Eigen::Vector3d position;
  double intensity = 0.0;  ///< radiance of a white surface that faces it at 1 m
};

struct Lighting {
  double ambient = 1.0;        ///< radiance of a white surface of shade 1: 1 by day, near 0 by night
  double sky = 2.0;            ///< radiance of the sky
  double head_lamps = 0.0;     ///< radiance of a white surface 1 m ahead of the camera in the beam's centre; 0: off
  double flicker_hz = 120.0;   ///< of the street lamps
  double flicker_depth = 0.5;  ///< relative amplitude of the flicker, in [0, 1)
  std::vector<Lamp> lamps;     ///< street lamps
};

/// The bonnet of the camera's own car. It mirrors the scene (render/bonnet_mirror.hpp).
struct Bonnet {
  double edge = 0.0;          ///< of its front, straight ahead: tangent of the angle below the horizon
  double reflectivity = 0.0;  ///< at normal incidence
  double radiance = 0.0;      ///< of its paint
  Eigen::Quaterniond R_vehicle_cam = Eigen::Quaterniond::Identity();
};

/// Light of the street lamps at `t` relative to its mean: 1 + depth sin(2 pi f t).
double Flicker(const Lighting& lighting, TimeNs t);

struct Scene {
  std::vector<Texture> textures;
  std::vector<Surface> surfaces;
  std::vector<Body> bodies;  ///< at least the static world
  Lighting lighting;
  std::optional<Bonnet> bonnet;
};

/// T_world_body of `body` at `t`; the identity for body 0.
geometry::SE3 BodyPose(const Scene& scene, int body, TimeNs t);

}  // namespace evo::simulation
