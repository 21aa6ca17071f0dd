#pragma once

#include <Eigen/Core>
#include <utility>

#include "simulation/world/scene.hpp"

namespace evo::simulation {

/// The appearance of a surface and the body that it belongs to.
struct Material {
  int texture = 0;
  Eigen::Vector2d texel_origin = Eigen::Vector2d::Zero();
  Eigen::Vector2d texels = Eigen::Vector2d::Ones();
  double tone = 1.0;      ///< factor of the texture's reflectance
  double emission = 0.0;  ///< radiance
  int body = 0;
};

/// Directional sunlight and uniform skylight.
struct Sun {
  Eigen::Vector3d towards = -Eigen::Vector3d::UnitY();  ///< unit vector
  double ratio = 0.0;                                   ///< of sunlight in the light on a surface that faces the sun
  /// Lambertian shading of a surface with this outward normal, at most 1.
  double DiffuseShade(const Eigen::Vector3d& normal) const;
};

/// Builds a scene, which has body 0, the static world, from the start.
class SceneBuilder {
 public:
  SceneBuilder();

  /// Returns the texture's index.
  int Add(Texture texture);
  /// Returns the body's index.
  int AddBody(Body body);
  void SetSun(const Sun& sun) { sun_ = sun; }
  /// The contrast of the textures that follow over that of their painting, in [0, 1].
  void SetContrast(double contrast) { contrast_ = contrast; }

  /// Adds a surface, shaded for the normal on the side of `outwards`.
  void Add(const Eigen::Vector3d& origin, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v,
           const Material& material, const Eigen::Vector3d& outwards);
  /// One period of a texture over the whole surface.
  Material WholeTexture(int texture, double tone = 1.0) const;
  /// Adds an upright box with `texture` on each of its six sides, rotated by `yaw` (rad) about its vertical axis.
  void AddBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& size, double yaw, int texture, double tone);

  Lighting& lighting() { return scene_.lighting; }
  Scene Take() { return std::move(scene_); }

 private:
  Scene scene_;
  Sun sun_;
  double contrast_ = 1.0;
};

}  // namespace evo::simulation
