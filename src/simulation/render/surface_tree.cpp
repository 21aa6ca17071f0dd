#include "evo/simulation/surface_tree.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "evo/core/error.hpp"

namespace evo::simulation {

using Eigen::Vector3d;

namespace {

constexpr int kLeafSize = 4;

std::array<Vector3d, 4> Corners(const Surface& s) {
  return {s.origin, s.origin + s.edge_u, s.origin + s.edge_v, s.origin + s.edge_u + s.edge_v};
}

}  // namespace

geometry::SE3 BodyPose(const Scene& scene, int body, TimeNs t) {
  return body == 0 ? geometry::SE3() : scene.bodies[body].T_world_body(t);
}

/// The bundle's sides, as planes through the camera, at both ends of a motion relative to a body.
class SurfaceTree::Sweep {
 public:
  Sweep(const RayBox& rays, const geometry::SE3& T_cam_body_from, const geometry::SE3& T_cam_body_to, double turn_rad,
        double travel_m)
      : ends_{End{T_cam_body_from.RotationMatrix(), T_cam_body_from.translation()},
              End{T_cam_body_to.RotationMatrix(), T_cam_body_to.translation()}},
        sides_{Vector3d(1, 0, -rays.x0).normalized(), Vector3d(-1, 0, rays.x1).normalized(),
               Vector3d(0, 1, -rays.y0).normalized(), Vector3d(0, -1, rays.y1).normalized(), Vector3d::UnitZ()},
        turn_(turn_rad),
        travel_(travel_m) {
    for (End& end : ends_) {
      for (int i = 0; i < kSides; ++i) end.sides[i] = end.rotation.transpose() * sides_[i];
      for (int i = 0; i < kSides; ++i) end.offsets[i] = sides_[i].dot(end.translation);
    }
  }

  /// Whether no plane has all of a box on its outer side, at both ends.
  bool MeetsBox(const Vector3d& centre, const Vector3d& half) const {
    const double stray = Stray(centre, half.norm());
    for (int i = 0; i < kSides; ++i) {
      bool outside = true;
      for (const End& end : ends_) {
        outside = outside && end.sides[i].dot(centre) + end.offsets[i] + end.sides[i].cwiseAbs().dot(half) < -stray;
      }
      if (outside) return false;
    }
    return true;
  }

  bool MeetsBall(const Vector3d& centre, double radius) const {
    const double stray = Stray(centre, radius);
    for (int i = 0; i < kSides; ++i) {
      bool outside = true;
      for (const End& end : ends_) outside = outside && end.sides[i].dot(centre) + end.offsets[i] + radius < -stray;
      if (outside) return false;
    }
    return true;
  }

  bool MeetsHull(const std::array<Vector3d, 4>& corners) const {
    double stray = 0.0;
    for (const Vector3d& corner : corners) stray = std::max(stray, Stray(corner, 0.0));
    for (int i = 0; i < kSides; ++i) {
      bool outside = true;
      for (const End& end : ends_) {
        for (const Vector3d& corner : corners) {
          outside = outside && end.sides[i].dot(corner) + end.offsets[i] < -stray;
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

  /// A point on a screw strays from the chord by up to 1/8 of its second derivative, turn^2 distance + 2 turn travel.
  /// Twice that is allowed for, since two screws in a row (camera and body) are not quite one.
  double Stray(const Vector3d& point, double radius) const {
    if (turn_ == 0.0) return 0.0;
    const double distance = std::max((ends_[0].rotation * point + ends_[0].translation).norm(),
                                     (ends_[1].rotation * point + ends_[1].translation).norm());
    return 0.25 * turn_ * (turn_ * (distance + radius) + 2.0 * travel_);
  }

  std::array<End, 2> ends_;
  std::array<Vector3d, kSides> sides_;
  double turn_;
  double travel_;
};

SurfaceTree::SurfaceTree(const Scene& scene) : scene_(scene) {
  bodies_.resize(scene.bodies.size());
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const Surface& surface = scene.surfaces[i];
    if (surface.body < 0 || surface.body >= static_cast<int>(scene.bodies.size()) || surface.texture < 0 ||
        surface.texture >= static_cast<int>(scene.textures.size())) {
      throw Error(ErrorKind::kInput, "scene: surface " + std::to_string(i) + " names texture " +
                                         std::to_string(surface.texture) + " and body " + std::to_string(surface.body) +
                                         ", which the scene has not");
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

void SurfaceTree::Build(int begin, int end) {
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d middles;
  for (int i = begin; i < end; ++i) {
    const auto& corners = corners_[order_[i]];
    for (const Vector3d& corner : corners) box.extend(corner);
    middles.extend(Vector3d(0.5 * (corners[0] + corners[3])));
  }
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back({box.center(), 0.5 * box.sizes(), begin, end});
  if (end - begin <= kLeafSize) {
    nodes_[index].leaf = true;
    nodes_[index].skip = index + 1;
    return;
  }
  int axis = 0;
  middles.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  const auto place = [&](int surface) { return corners_[surface][0][axis] + corners_[surface][3][axis]; };
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](int a, int b) { return std::pair(place(a), a) < std::pair(place(b), b); });
  Build(begin, middle);
  Build(middle, end);
  nodes_[index].skip = static_cast<int>(nodes_.size());
}

std::vector<int> SurfaceTree::Find(const RayBox& rays, TimeNs from, TimeNs to, const geometry::SE3& T_world_cam_from,
                                   const geometry::SE3& T_world_cam_to) const {
  std::vector<int> found;
  const geometry::SE3 T_cam_world_from = T_world_cam_from.Inverse();
  const geometry::SE3 T_cam_world_to = T_world_cam_to.Inverse();
  const auto turn = [](const geometry::SE3& a, const geometry::SE3& b) {
    return a.rotation().angularDistance(b.rotation());
  };
  const auto travel = [](const geometry::SE3& a, const geometry::SE3& b) {
    return (a.translation() - b.translation()).norm();
  };
  const double camera_turn = turn(T_world_cam_from, T_world_cam_to);
  const double camera_travel = travel(T_world_cam_from, T_world_cam_to);

  const Sweep still(rays, T_cam_world_from, T_cam_world_to, camera_turn, camera_travel);
  for (int i = 0; i < static_cast<int>(nodes_.size());) {
    const Node& node = nodes_[i];
    const bool meets = still.MeetsBox(node.centre, node.half);
    if (meets && node.leaf) {
      for (int k = node.begin; k < node.end; ++k) {
        if (still.MeetsHull(corners_[order_[k]])) found.push_back(order_[k]);
      }
    }
    i = meets ? i + 1 : node.skip;
  }
  for (const MovingBody& body : bodies_) {
    const geometry::SE3 T_world_body_from = BodyPose(scene_, body.body, from);
    const geometry::SE3 T_world_body_to = BodyPose(scene_, body.body, to);
    const Sweep moving(rays, T_cam_world_from * T_world_body_from, T_cam_world_to * T_world_body_to,
                       camera_turn + turn(T_world_body_from, T_world_body_to),
                       camera_travel + travel(T_world_body_from, T_world_body_to));
    if (!moving.MeetsBall(Vector3d::Zero(), body.radius)) continue;
    for (const int surface : body.surfaces) {
      if (moving.MeetsHull(corners_[surface])) found.push_back(surface);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace evo::simulation
