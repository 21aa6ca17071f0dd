#include "simulation/world/scene_builder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace evo::simulation {

double Sun::DiffuseShade(const Eigen::Vector3d& normal) const {
  return 1.0 - ratio + ratio * std::max(0.0, normal.dot(towards));
}

SceneBuilder::SceneBuilder() {
  scene_.bodies.push_back({[](TimeNs) { return geometry::SE3(); }});
}

int SceneBuilder::Add(Texture texture) {
  if (contrast_ != 1.0) texture.ScaleContrast(static_cast<float>(contrast_));
  scene_.textures.push_back(std::move(texture));
  return static_cast<int>(scene_.textures.size()) - 1;
}

int SceneBuilder::AddBody(Body body) {
  scene_.bodies.push_back(std::move(body));
  return static_cast<int>(scene_.bodies.size()) - 1;
}

void SceneBuilder::Add(const Eigen::Vector3d& origin, const Eigen::Vector3d& edge_u, const Eigen::Vector3d& edge_v,
                       const Material& material, const Eigen::Vector3d& outwards) {
  Eigen::Vector3d normal = edge_u.cross(edge_v).normalized();
  if (normal.dot(outwards) < 0.0) normal = -normal;
  Surface surface;
  surface.origin = origin;
  surface.edge_u = edge_u;
  surface.edge_v = edge_v;
  surface.texture = material.texture;
  surface.texel_origin = material.texel_origin;
  surface.texels = material.texels;
  surface.shade = static_cast<float>(material.tone * sun_.DiffuseShade(normal));
  surface.emission = static_cast<float>(material.emission);
  surface.body = material.body;
  scene_.surfaces.push_back(surface);
}

Material SceneBuilder::WholeTexture(int texture, double tone) const {
  Material material;
  material.texture = texture;
  material.texels = {scene_.textures[texture].width(), scene_.textures[texture].height()};
  material.tone = tone;
  return material;
}

void SceneBuilder::AddBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& size, double yaw, int texture,
                          double tone) {
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()).toRotationMatrix();
  for (int axis = 0; axis < 3; ++axis) {
    // v points down on the upright sides.
    const int v_axis = axis == 1 ? 2 : 1;
    const int u_axis = 3 - axis - v_axis;
    const Eigen::Vector3d v = axes.col(v_axis) * size[v_axis];
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d outwards = axes.col(axis) * side;
      const Eigen::Vector3d u = outwards.cross(axes.col(v_axis)) * size[u_axis];  // to the viewer's right
      Add(centre + outwards * (0.5 * size[axis]) - 0.5 * (u + v), u, v, WholeTexture(texture, tone), outwards);
    }
  }
}

}  // namespace evo::simulation
