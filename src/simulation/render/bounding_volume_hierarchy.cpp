#include "simulation/render/bounding_volume_hierarchy.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "evo/core/error.hpp"

namespace evo::simulation {

using Eigen::Vector3d;

namespace {

constexpr int kLeafSize = 4;  // surfaces; smaller leaves make a deeper tree without testing fewer surfaces

std::array<Vector3d, 4> Corners(const Surface& s) {
  return {s.origin, s.origin + s.edge_u, s.origin + s.edge_v, s.origin + s.edge_u + s.edge_v};
}

}  // namespace

/// The planes of the frustum's sides at both ends of a motion relative to a body.
class BoundingVolumeHierarchy::SweptFrustum {
 public:
  SweptFrustum(const RayFrustum& rays, const geometry::SE3& T_cam_body_from, const geometry::SE3& T_cam_body_to,
               double rotation_rad, double translation_m)
      : ends_{End{T_cam_body_from.RotationMatrix(), T_cam_body_from.translation()},
              End{T_cam_body_to.RotationMatrix(), T_cam_body_to.translation()}},
        sides_{Vector3d(1, 0, -rays.x0).normalized(), Vector3d(-1, 0, rays.x1).normalized(),
               Vector3d(0, 1, -rays.y0).normalized(), Vector3d(0, -1, rays.y1).normalized(), Vector3d::UnitZ()},
        rotation_(rotation_rad),
        translation_(translation_m) {
    for (End& end : ends_) {
      for (int i = 0; i < kSides; ++i) end.sides[i] = end.rotation.transpose() * sides_[i];
      for (int i = 0; i < kSides; ++i) end.offsets[i] = sides_[i].dot(end.translation);
    }
  }

  /// False if a plane has all of the box on its outer side at both ends.
  bool IntersectsBox(const Vector3d& centre, const Vector3d& half_size) const {
    const double deviation = ChordDeviation(centre, half_size.norm());
    for (int i = 0; i < kSides; ++i) {
      bool outside = true;
      for (const End& end : ends_) {
        outside =
            outside && end.sides[i].dot(centre) + end.offsets[i] + end.sides[i].cwiseAbs().dot(half_size) < -deviation;
      }
      if (outside) return false;
    }
    return true;
  }

  bool IntersectsSphere(const Vector3d& centre, double radius) const {
    const double deviation = ChordDeviation(centre, radius);
    for (int i = 0; i < kSides; ++i) {
      bool outside = true;
      for (const End& end : ends_) outside = outside && end.sides[i].dot(centre) + end.offsets[i] + radius < -deviation;
      if (outside) return false;
    }
    return true;
  }

  bool IntersectsHull(const std::array<Vector3d, 4>& corners) const {
    double deviation = 0.0;
    for (const Vector3d& corner : corners) deviation = std::max(deviation, ChordDeviation(corner, 0.0));
    for (int i = 0; i < kSides; ++i) {
      bool outside = true;
      for (const End& end : ends_) {
        for (const Vector3d& corner : corners) {
          outside = outside && end.sides[i].dot(corner) + end.offsets[i] < -deviation;
        }
      }
      if (outside) return false;
    }
    return true;
  }

 private:
  static constexpr int kSides = 5;
  struct End {
    Eigen::Matrix3d rotation;
    Vector3d translation;
    std::array<Vector3d, kSides> sides{};  ///< in the body's frame
    std::array<double, kSides> offsets{};
  };

  /// A point on a screw deviates from its chord by up to 1/8 of its second derivative,
  /// rotation^2 distance + 2 rotation translation. The bound is twice that, since the composition of two screws (camera
  /// and body) is not quite one.
  double ChordDeviation(const Vector3d& point, double radius) const {
    if (rotation_ == 0.0) return 0.0;
    const double distance = std::max((ends_[0].rotation * point + ends_[0].translation).norm(),
                                     (ends_[1].rotation * point + ends_[1].translation).norm());
    return 0.25 * rotation_ * (rotation_ * (distance + radius) + 2.0 * translation_);
  }

  std::array<End, 2> ends_;
  std::array<Vector3d, kSides> sides_;
  double rotation_;     ///< rad
  double translation_;  ///< m
};

BoundingVolumeHierarchy::BoundingVolumeHierarchy(const Scene& scene) : scene_(scene) {
  bodies_.resize(scene.bodies.size());
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const Surface& surface = scene.surfaces[i];
    if (surface.body < 0 || surface.body >= static_cast<int>(scene.bodies.size()) || surface.texture < 0 ||
        surface.texture >= static_cast<int>(scene.textures.size())) {
      throw Error(
          ErrorKind::kInput,
          fmt::format("scene: surface {} names texture {} and body {}, but the scene has {} textures and {} bodies", i,
                      surface.texture, surface.body, scene.textures.size(), scene.bodies.size()));
    }
    corners_.push_back(Corners(surface));
    if (surface.body == 0) {
      order_.push_back(static_cast<int>(i));
      continue;
    }
    MovingBody& body = bodies_[surface.body];
    body.body = surface.body;
    body.surfaces.push_back(static_cast<int>(i));
    for (const Vector3d& corner : corners_.back()) body.radius = std::max(body.radius, corner.norm());
  }
  std::erase_if(bodies_, [](const MovingBody& body) { return body.surfaces.empty(); });
  if (!order_.empty()) Build(0, static_cast<int>(order_.size()));
}

void BoundingVolumeHierarchy::Build(int begin, int end) {
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d centres;
  for (int i = begin; i < end; ++i) {
    const auto& corners = corners_[order_[i]];
    for (const Vector3d& corner : corners) box.extend(corner);
    centres.extend(Vector3d(0.5 * (corners[0] + corners[3])));
  }
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back({box.center(), 0.5 * box.sizes(), begin, end});
  if (end - begin <= kLeafSize) {
    nodes_[index].leaf = true;
    nodes_[index].skip = index + 1;
    return;
  }
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  const auto position = [&](int surface) { return corners_[surface][0][axis] + corners_[surface][3][axis]; };
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](int a, int b) { return std::pair(position(a), a) < std::pair(position(b), b); });
  Build(begin, middle);
  Build(middle, end);
  nodes_[index].skip = static_cast<int>(nodes_.size());
}

std::vector<int> BoundingVolumeHierarchy::Find(const RayFrustum& rays, TimeNs from, TimeNs to,
                                               const geometry::SE3& T_world_cam_from,
                                               const geometry::SE3& T_world_cam_to) const {
  std::vector<int> found;
  const geometry::SE3 T_cam_world_from = T_world_cam_from.Inverse();
  const geometry::SE3 T_cam_world_to = T_world_cam_to.Inverse();
  const auto angle = [](const geometry::SE3& a, const geometry::SE3& b) {
    return a.rotation().angularDistance(b.rotation());
  };
  const auto distance = [](const geometry::SE3& a, const geometry::SE3& b) {
    return (a.translation() - b.translation()).norm();
  };
  const double camera_rotation = angle(T_world_cam_from, T_world_cam_to);
  const double camera_translation = distance(T_world_cam_from, T_world_cam_to);

  const SweptFrustum static_world(rays, T_cam_world_from, T_cam_world_to, camera_rotation, camera_translation);
  for (int i = 0; i < static_cast<int>(nodes_.size());) {
    const Node& node = nodes_[i];
    const bool intersects = static_world.IntersectsBox(node.centre, node.half_size);
    if (intersects && node.leaf) {
      for (int k = node.begin; k < node.end; ++k) {
        if (static_world.IntersectsHull(corners_[order_[k]])) found.push_back(order_[k]);
      }
    }
    i = intersects ? i + 1 : node.skip;
  }
  for (const MovingBody& body : bodies_) {
    const geometry::SE3 T_world_body_from = BodyPose(scene_, body.body, from);
    const geometry::SE3 T_world_body_to = BodyPose(scene_, body.body, to);
    const SweptFrustum moving(rays, T_cam_world_from * T_world_body_from, T_cam_world_to * T_world_body_to,
                              camera_rotation + angle(T_world_body_from, T_world_body_to),
                              camera_translation + distance(T_world_body_from, T_world_body_to));
    if (!moving.IntersectsSphere(Vector3d::Zero(), body.radius)) continue;
    for (const int surface : body.surfaces) {
      if (moving.IntersectsHull(corners_[surface])) found.push_back(surface);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace evo::simulation
