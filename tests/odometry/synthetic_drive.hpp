#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::odometry::testing {

struct DriveOptions {
  double seconds = 12.0;
  double speed = 7.0;            ///< m/s
  double noise_px = 0.4;         ///< one sigma, each coordinate
  double outliers = 0.07;        ///< share of tracks that sit on something that moves by itself
  int features = 100;            ///< refilled when a fifth is gone
  double mean_life_frames = 25;  ///< of a track that does not leave the image
  bool stop = true;              ///< stands still for 1.5 s in the middle
  bool bumps = true;             ///< at a third and at two thirds
  TimeNs blackout = 0;           ///< for so long in the middle there are no tracks at all
  std::uint32_t seed = 1;
};

struct Drive {
  events::Tracks tracks;
  geometry::Trajectory truth;  ///< T_world_cam at every frame, metres
};

inline geometry::Camera DriveCamera() {
  return geometry::Camera({geometry::Distortion::kEquidistant,
                           346,
                           260,
                           226.38,
                           226.15,
                           173.65,
                           133.73,
                           {-0.0480, 0.01133, -0.05538, 0.0215, 0.0}});
}

/// A car in a gently curving street: ground and facades 3 to 40 m away, the camera 1.5 m above the ground.
inline Drive MakeDrive(const DriveOptions& options) {
  constexpr double kInterval = 0.025;
  constexpr double kHeight = 1.5;
  const geometry::Camera camera = DriveCamera();
  std::mt19937 random(options.seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  struct Live {
    std::int64_t id;
    Eigen::Vector3d point, velocity;  // world
  };
  std::vector<Live> live;
  Drive drive;
  std::int64_t next_id = 0;
  double heading = 0.0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  const int frames = static_cast<int>(options.seconds / kInterval);
  const TimeNs start = 1'504'645'177'420'000'000;

  for (int i = 0; i < frames; ++i) {
    const double t = i * kInterval;
    double speed = options.speed;
    if (options.stop) {
      const double from_middle = std::abs(t - 0.5 * options.seconds);
      speed *= std::clamp((from_middle - 0.75) / 1.5, 0.0, 1.0);
    }
    double pitch = 0.0, lift = 0.0;
    for (const double at : {options.seconds / 3.0, 2.0 * options.seconds / 3.0}) {
      const double phase = (t - at) / 0.5;
      if (!options.bumps || phase < 0.0 || phase > 1.0) continue;
      pitch += 0.03 * std::sin(2.0 * M_PI * phase);
      lift -= 0.06 * std::sin(M_PI * phase);
    }
    heading += 0.009 * std::sin(2.0 * M_PI * t / 12.0) * kInterval * speed;
    position += kInterval * speed * Eigen::Vector3d(std::sin(heading), 0.0, std::cos(heading));
    const Eigen::Quaterniond rotation = geometry::so3::Exp({0, heading, 0}) * geometry::so3::Exp({pitch, 0, 0});
    const geometry::SE3 T_world_cam(rotation, position + Eigen::Vector3d(0, lift, 0));
    const geometry::SE3 T_cam_world = T_world_cam.Inverse();
    const TimeNs stamp = start + i * FromSeconds(kInterval);
    drive.truth.push_back({stamp, T_world_cam});
    if (std::abs(t - 0.5 * options.seconds) < 0.5 * ToSeconds(options.blackout)) {
      live.clear();
      continue;
    }

    // A track ends where it leaves the image or the tracker slips.
    std::erase_if(live, [&](Live& track) {
      track.point += kInterval * track.velocity;
      const Eigen::Vector3d p = T_cam_world * track.point;
      const bool slips = speed > 0.1 && uniform(random) < 1.0 / options.mean_life_frames;
      return p.z() < 1.0 || !camera.Contains(camera.Project(p), 4.0) || slips;
    });
    if (static_cast<double>(live.size()) < 0.8 * options.features) {
      while (static_cast<int>(live.size()) < options.features) {
        const Eigen::Vector2d pixel(8.0 + 330.0 * uniform(random), 8.0 + 244.0 * uniform(random));
        const Eigen::Vector3d ray = camera.Undistort(pixel)->homogeneous();
        const double facade = 5.0 + 7.0 * uniform(random);
        const double depth = std::min(ray.y() > 0.02 ? kHeight / ray.y() : 1e9, facade / std::abs(ray.x()));
        if (depth < 3.0 || depth > 40.0 || depth * ray.y() < -8.0) continue;
        Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
        if (uniform(random) < options.outliers)
          velocity = Eigen::Vector3d(4.0 * normal(random), 0, 8.0 * normal(random));
        live.push_back({next_id++, T_world_cam * (depth * ray), velocity});
      }
    }
    for (const Live& track : live) {
      const Eigen::Vector2d pixel = camera.Project(T_cam_world * track.point) +
                                    options.noise_px * Eigen::Vector2d(normal(random), normal(random));
      drive.tracks.push_back({track.id, stamp, pixel.x(), pixel.y()});
    }
  }
  return drive;
}

}  // namespace evo::odometry::testing
