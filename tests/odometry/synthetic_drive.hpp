#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::odometry::testing {

struct DriveOptions {
  double seconds = 12.0;
  double speed = 7.0;            ///< m/s
  double noise_px = 0.4;         ///< standard deviation of each coordinate
  double outlier_ratio = 0.07;   ///< of tracks on moving objects
  int features = 100;            ///< refilled when a fifth is gone
  double mean_life_frames = 25;  ///< of a track that does not leave the image
  bool stop = true;              ///< for 1.5 s in the middle
  bool bumps = true;             ///< at a third and at two thirds
  TimeNs blackout = 0;           ///< duration without tracks in the middle
  std::uint32_t seed = 1;
};

struct Drive {
  events::Tracks tracks;
  geometry::Trajectory truth;  ///< at every frame, m
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
class DriveMaker {
 public:
  explicit DriveMaker(const DriveOptions& options) : options_(options), random_(options.seed) {}

  Drive Make() {
    const int frames = static_cast<int>(options_.seconds / kInterval);
    for (int i = 0; i < frames; ++i) {
      const double t = i * kInterval;
      Move(t);
      const TimeNs stamp = kStart + i * FromSeconds(kInterval);
      drive_.truth.push_back({stamp, T_world_cam_});
      if (std::abs(t - 0.5 * options_.seconds) < 0.5 * ToSeconds(options_.blackout)) {
        tracks_.clear();
        continue;
      }
      EndTracks();
      if (static_cast<double>(tracks_.size()) < 0.8 * options_.features) StartTracks();
      Observe(stamp);
    }
    return std::move(drive_);
  }

 private:
  static constexpr double kInterval = 0.025;  // s, between the frames
  static constexpr double kHeight = 1.5;      // m
  static constexpr TimeNs kStart = 1'504'645'177'420'000'000;

  struct Track {
    std::int64_t id;
    Eigen::Vector3d point, velocity;  // world
  };

  double Uniform() { return uniform_(random_); }
  double Normal() { return normal_(random_); }

  void Move(double t) {
    speed_ = options_.speed;
    if (options_.stop) {
      const double from_middle = std::abs(t - 0.5 * options_.seconds);
      speed_ *= std::clamp((from_middle - 0.75) / 1.5, 0.0, 1.0);
    }
    double pitch = 0.0, lift = 0.0;
    for (const double bump : {options_.seconds / 3.0, 2.0 * options_.seconds / 3.0}) {
      const double phase = (t - bump) / 0.5;
      if (!options_.bumps || phase < 0.0 || phase > 1.0) continue;
      pitch += 0.03 * std::sin(2.0 * M_PI * phase);
      lift -= 0.06 * std::sin(M_PI * phase);
    }
    heading_ += 0.009 * std::sin(2.0 * M_PI * t / 12.0) * kInterval * speed_;
    position_ += kInterval * speed_ * Eigen::Vector3d(std::sin(heading_), 0.0, std::cos(heading_));
    const Eigen::Quaterniond rotation = geometry::so3::Exp({0, heading_, 0}) * geometry::so3::Exp({pitch, 0, 0});
    T_world_cam_ = geometry::SE3(rotation, position_ + Eigen::Vector3d(0, lift, 0));
  }

  /// A track ends where it leaves the image or the tracker loses it.
  void EndTracks() {
    const geometry::SE3 T_cam_world = T_world_cam_.Inverse();
    std::erase_if(tracks_, [&](Track& track) {
      track.point += kInterval * track.velocity;
      const Eigen::Vector3d p = T_cam_world * track.point;
      const bool is_lost = speed_ > 0.1 && Uniform() < 1.0 / options_.mean_life_frames;
      return p.z() < 1.0 || !camera_.Contains(camera_.Project(p), 4.0) || is_lost;
    });
  }

  void StartTracks() {
    while (static_cast<int>(tracks_.size()) < options_.features) {
      const Eigen::Vector2d pixel(8.0 + 330.0 * Uniform(), 8.0 + 244.0 * Uniform());
      const Eigen::Vector3d ray = camera_.Undistort(pixel)->homogeneous();
      const double facade = 5.0 + 7.0 * Uniform();
      const double depth = std::min(ray.y() > 0.02 ? kHeight / ray.y() : 1e9, facade / std::abs(ray.x()));
      if (depth < 3.0 || depth > 40.0 || depth * ray.y() < -8.0) continue;
      Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
      if (Uniform() < options_.outlier_ratio) velocity = Eigen::Vector3d(4.0 * Normal(), 0, 8.0 * Normal());
      tracks_.push_back({next_id_++, T_world_cam_ * (depth * ray), velocity});
    }
  }

  void Observe(TimeNs stamp) {
    const geometry::SE3 T_cam_world = T_world_cam_.Inverse();
    for (const Track& track : tracks_) {
      const Eigen::Vector2d pixel =
          camera_.Project(T_cam_world * track.point) + options_.noise_px * Eigen::Vector2d(Normal(), Normal());
      drive_.tracks.push_back({track.id, stamp, pixel.x(), pixel.y()});
    }
  }

  DriveOptions options_;
  geometry::Camera camera_ = DriveCamera();
  std::mt19937 random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
  std::vector<Track> tracks_;
  std::int64_t next_id_ = 0;
  double speed_ = 0.0;
  double heading_ = 0.0;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  geometry::SE3 T_world_cam_;
  Drive drive_;
};

inline Drive MakeDrive(const DriveOptions& options) { return DriveMaker(options).Make(); }

}  // namespace evo::odometry::testing
