#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "evo/events/depth_map.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/known_cameras.hpp"
#include "evo/geometry/trajectory.hpp"
#include "evo/io/mvsec_writer.hpp"

namespace evo::evaluation::testing {

constexpr TimeNs kSceneStart = 1500000000'000000000;
constexpr TimeNs kMapInterval = 50'000'000;

/// 100 px focal length, no distortion, the axis in the middle of 201 x 151 px.
inline geometry::Camera PlainCamera() {
  return geometry::Camera({geometry::Distortion::kRadTan, 201, 151, 100.0, 100.0, 100.0, 75.0, {}});
}

/// The left DAVIS of MVSEC's outdoor_day.
inline geometry::Camera MvsecCamera() { return geometry::Camera(geometry::MvsecDavis346()); }

/// A wall in the world: n . X = 1 with normal / distance n, seen where left <= X <= right.
struct Wall {
  Eigen::Vector3d n;
  double left = -1e9;
  double right = 1e9;
  bool moves = false;  ///< marked as moving, although it is static
};

/// The first surface that a ray meets.
struct Meeting {
  double depth = std::numeric_limits<double>::quiet_NaN();  ///< along z; NaN without a surface
  bool moves = false;
};
inline Meeting Meet(const Eigen::Vector3d& ray_cam, const geometry::SE3& T_world_cam, const std::vector<Wall>& walls) {
  const Eigen::Vector3d ray = T_world_cam.rotation() * ray_cam;
  Meeting nearest;
  for (const Wall& wall : walls) {
    const double z = (1.0 - wall.n.dot(T_world_cam.translation())) / wall.n.dot(ray);
    const double x = T_world_cam.translation().x() + z * ray.x();
    if (z > 0.0 && x >= wall.left && x <= wall.right && !(z >= nearest.depth)) nearest = {z, wall.moves};
  }
  return nearest;
}

inline events::DepthMap Render(const geometry::Camera& camera, const geometry::SE3& T_world_cam,
                               const std::vector<Wall>& walls) {
  events::DepthMap map{camera.width(), camera.height(), {}};
  for (int y = 0; y < camera.height(); ++y) {
    for (int x = 0; x < camera.width(); ++x) {
      const auto ray = camera.Undistort({x, y});
      const Meeting meeting = ray ? Meet(ray->homogeneous(), T_world_cam, walls) : Meeting{.depth = 0.0};
      map.depth.push_back(meeting.depth);
      map.moving.push_back(meeting.moves ? 1 : 0);
    }
  }
  return map;
}

/// Seconds of a straight drive with constant velocity (m/s) and turning rate (rad/s), poses and maps at 20 Hz.
struct TrackScene {
  geometry::Camera camera = PlainCamera();
  std::vector<Wall> walls{{Eigen::Vector3d(0.0, 0.0, 0.1)}};  // 10 m ahead
  Eigen::Vector3d velocity{1.0, 0.0, 0.0};
  Eigen::Vector3d turning = Eigen::Vector3d::Zero();
  double seconds = 2.0;

  geometry::SE3 PoseAfter(double s) const { return {geometry::so3::Exp(s * turning), s * velocity}; }
  TimeNs Stamp(double s) const { return kSceneStart + FromSeconds(s); }

  geometry::Trajectory Poses() const {
    geometry::Trajectory poses;
    for (int i = 0; i * kMapInterval <= FromSeconds(seconds); ++i) {
      const TimeNs t = i * kMapInterval;
      poses.push_back({kSceneStart + t, PoseAfter(ToSeconds(t))});
    }
    return poses;
  }

  void WriteGroundTruth(const std::filesystem::path& path) const {
    io::MvsecGroundTruthWriter writer(path, Poses(), Poses());
    for (const auto& [t, T_world_cam] : Poses()) writer.AppendDepth(t, Render(camera, T_world_cam, walls));
    writer.Commit();
  }

  /// The track of the point behind `pixel` at `from` seconds, every 10 ms until `to`, occluded or not.
  events::Tracks Follow(std::int64_t id, const Eigen::Vector2d& pixel, double from, double to) const {
    const geometry::Trajectory poses = Poses();
    const geometry::SE3 T_first = *geometry::PoseAt(poses, Stamp(from), kNsPerSecond);
    const Eigen::Vector3d ray = camera.Undistort(pixel)->homogeneous();
    const Eigen::Vector3d point = T_first * (Meet(ray, T_first, walls).depth * ray);
    events::Tracks track;
    for (TimeNs t = Stamp(from); t <= Stamp(to); t += 10'000'000) {
      const Eigen::Vector2d seen = camera.Project(geometry::PoseAt(poses, t, kNsPerSecond)->Inverse() * point);
      track.push_back({id, t, seen.x(), seen.y()});
    }
    return track;
  }
};

}  // namespace evo::evaluation::testing
