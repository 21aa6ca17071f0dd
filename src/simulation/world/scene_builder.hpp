#pragma once

#include <Eigen/Core>
#include <utility>

#include "evo/simulation/scene.hpp"

namespace evo::simulation {

/// What a surface shows.
struct Look {
  int texture = 0;
  Eigen::Vector2d texel_origin = Eigen::Vector2d::Zero();
  Eigen::Vector2d texels = Eigen::Vector2d::Ones();
  double tone = 1.0;  ///< scales the texture's reflectance
  double emission = 0.0;
  int body = 0;
};

/// Sunlight from one direction and light from the whole sky.
struct Sun {
  Eigen::Vector3d towards = -Eigen::Vector3d::UnitY();  ///< unit vector
  double share = 0.0;                                   ///< of the sun in the light on a surface that faces it
  /// Light on a surface with this outward normal, 1 at most.
  double Shade(const Eigen::Vector3d& normal) const;
};

/// Collects a scene. Body 0, the static world, is there from the start.
class SceneBuilder {
 public:
  SceneBuilder();

  int Add(Texture texture);
  int AddBody(Body body);
  void SetSun(const Sun& sun) { sun_ = sun; }

  /// Lit as a surface whose outward normal points to the side of `outwards`.
  void Add(const Eigen::Vector3d& origin, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v,
           const Look& look, const Eigen::Vector3d& outwards);
  /// The whole of a texture.
  Look Whole(int texture, double tone = 1.0) const;
  /// An upright axis-parallel box, each of its six sides with the whole of `texture`, turned about the vertical through
  /// its centre.
  void AddBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& size, double turn, int texture, double tone);

  Lighting& lighting() { return scene_.lighting; }
  Scene Take() { return std::move(scene_); }

 private:
  Scene scene_;
  Sun sun_;
};

}  // namespace evo::simulation
