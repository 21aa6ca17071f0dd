#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "evo/core/time.hpp"
#include "odometry/frontend/frame.hpp"
#include "odometry/segment.hpp"

namespace evo::odometry::testing {

inline constexpr double kStreetCameraHeightM = 1.5;
inline constexpr double kStreetStepM = 0.16;  ///< from frame to frame
inline constexpr double kStreetFocalPx = 226;

struct StreetOptions {
  int frames = 1000;
  int features = 150;
  double noise_px = 0.3;
  double outliers = 0.1;      ///< ratio of tracks on objects that move by themselves
  double pitch = 0.0;         ///< of the camera in the car, rad; positive looks down
  double roll = 0.0;          ///< of the camera in the car, rad
  double curvature = 0.0;     ///< amplitude of the path's curvature, rad/m
  double hills = 0.0;         ///< maximum slope
  double bare_from_m = 1e9;   ///< the road has no texture from here
  double bare_to_m = 0.0;     ///< to here
  bool road = true;           ///< else walls only
  double road_tracks_hz = 0;  ///< new tracks on the ground a second at most; 0: as many as the image shows
  double pavement_m = 0.0;    ///< height of the pavements, which begin 3 m beside the road's middle
  double heave = 0.0;         ///< relative amplitude of the camera's height, period 10 m: carried, not driven
  double climb = 0.0;         ///< relative gain of height over the second half of the path: an aircraft
  double lost_at_m = 1e9;     ///< the tracking restarts here with another scale
  unsigned seed = 1;
};

/// A drive as the odometry would have estimated it: all frames, and poses with a scale that drifts.
struct Street {
  std::vector<Frame> frames;
  std::vector<geometry::SE3> T_cam_world;    ///< true, m
  std::vector<double> scale;                 ///< true, m to a unit, at every frame
  std::vector<Segment> segments;             ///< as estimated
  std::map<std::int64_t, int> first_frames;  ///< of the tracks of the maps' points
};

class StreetSimulator {
 public:
  explicit StreetSimulator(const StreetOptions& options) : options_(options), random_(options.seed) {}

  Street Simulate() {
    for (int i = 0; i < options_.frames; ++i) {
      street_.T_cam_world.push_back(Pose(i).Inverse());
      street_.frames.push_back({i * FromSeconds(0.02), {}, {}});
      MoveTracks();
      while (static_cast<int>(tracks_.size()) < options_.features) AddTrack();
      Observe();
    }
    Estimate();
    return std::move(street_);
  }

 private:
  struct Track {
    std::int64_t id;
    Eigen::Vector3d position, velocity;  // world, a frame
    int end_frame;
  };

  double RoadHeight(double z) const { return options_.hills / 0.05 * (1.0 - std::cos(0.05 * z)); }  // downwards

  double CameraHeight(double z) const {
    const double half = 0.5 * options_.frames * kStreetStepM;
    return kStreetCameraHeightM *
           (1.0 + options_.heave * std::sin(0.6 * z) + options_.climb * std::max(0.0, z / half - 1.0));
  }

  /// T_world_cam of a car parallel to the road and the camera in it.
  geometry::SE3 Pose(int frame) const {
    const double z = frame * kStreetStepM;
    const double slope = options_.hills * std::sin(0.05 * z);
    const double x = options_.curvature / 0.0016 * (1.0 - std::cos(0.04 * z));
    const double heading = std::atan(options_.curvature / 0.04 * std::sin(0.04 * z));
    const Eigen::Quaterniond car = geometry::so3::Exp({0, heading, 0}) * geometry::so3::Exp({-std::atan(slope), 0, 0});
    const Eigen::Quaterniond camera =
        geometry::so3::Exp({-options_.pitch, 0, 0}) * geometry::so3::Exp({0, 0, options_.roll});
    return {car * camera, Eigen::Vector3d(x, RoadHeight(z), z) + car * Eigen::Vector3d(0, -CameraHeight(z), 0)};
  }

  /// The point where a ray from the camera meets the road or a wall, up to 40 m away.
  std::optional<Eigen::Vector3d> Intersect(const geometry::SE3& T_world_cam, const Eigen::Vector2d& x) {
    const double wall = 5.0 + 5.0 * Uniform();
    const Eigen::Vector3d from = T_world_cam.translation();
    const Eigen::Vector3d ray = T_world_cam.rotation() * x.homogeneous();
    const auto above = [&](double depth) {
      const Eigen::Vector3d at = from + depth * ray;
      return RoadHeight(at.z()) - (std::abs(at.x()) > 3.0 ? options_.pavement_m : 0.0) - at.y();
    };
    constexpr double kRayStep = 0.1;
    for (double depth = 2.0; depth < 40.0; depth += kRayStep) {
      if (above(depth) < 0.0) {
        const double before = above(depth - kRayStep);
        const Eigen::Vector3d at = from + (depth - kRayStep * (1.0 - before / (before - above(depth)))) * ray;
        const bool bare = at.z() > options_.bare_from_m && at.z() < options_.bare_to_m;
        return options_.road && !bare && AddsRoadTrack() ? std::optional(at) : std::nullopt;
      }
      if (std::abs(depth * ray.x()) > wall) return from + depth * ray;
    }
    return std::nullopt;
  }

  bool AddsRoadTrack() {
    const double time_s = 0.02 * static_cast<double>(street_.frames.size());
    if (options_.road_tracks_hz > 0.0 && road_tracks_ >= options_.road_tracks_hz * time_s) return false;
    ++road_tracks_;
    return true;
  }

  double Uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  double Normal() { return std::normal_distribution<double>(0.0, 1.0)(random_); }

  void AddTrack() {
    const Eigen::Vector2d x(1.5 * Uniform() - 0.75, 1.1 * Uniform() - 0.55);
    const auto position = Intersect(street_.T_cam_world.back().Inverse(), x);
    if (!position) return;
    Track track{next_id_++, *position, Eigen::Vector3d::Zero(), 0};
    if (Uniform() < options_.outliers)
      track.velocity = 0.02 * Eigen::Vector3d(3 * Normal(), 0.3 * Normal(), 6 * Normal());
    track.end_frame = static_cast<int>(street_.frames.size()) + 10 + static_cast<int>(50 * Uniform());
    if (track.velocity.isZero()) street_.first_frames[track.id] = static_cast<int>(street_.frames.size()) - 1;
    tracks_.push_back(track);
  }

  void MoveTracks() {
    const int now = static_cast<int>(street_.frames.size());
    std::erase_if(tracks_, [&](Track& track) {
      track.position += track.velocity;
      const Eigen::Vector3d p = street_.T_cam_world.back() * track.position;
      return now >= track.end_frame || p.z() < 0.5 || std::abs(p.x()) > 0.8 * p.z() || std::abs(p.y()) > 0.6 * p.z();
    });
  }

  void Observe() {
    for (const Track& track : tracks_) {
      const Eigen::Vector3d p = street_.T_cam_world.back() * track.position;
      const Eigen::Vector2d noise = options_.noise_px / kStreetFocalPx * Eigen::Vector2d(Normal(), Normal());
      street_.frames.back().features.push_back(
          {track.id, p.head<2>() / p.z() + noise, kStreetFocalPx * Eigen::Matrix2d::Identity()});
    }
    for (const Track& track : tracks_) positions_[track.id] = track.position;
  }

  void Estimate() {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    for (int i = 0; i < options_.frames; ++i) {
      const double z = i * kStreetStepM;
      const bool lost = z >= options_.lost_at_m;
      const double scale = (lost ? 2.6 : 2.0) * (1.0 + 0.03 * std::sin(0.03 * z));
      street_.scale.push_back(scale);
      const geometry::SE3 T_world_cam = street_.T_cam_world[i].Inverse();
      if (i > 0) position += (T_world_cam.translation() - Pose(i - 1).translation()) / scale;
      if (street_.segments.size() < (lost ? 2u : 1u)) street_.segments.emplace_back();
      Segment& segment = street_.segments.back();
      segment.poses.push_back({i, geometry::SE3(T_world_cam.rotation(), position).Inverse(), 100});
      for (const auto& [track, first_frame] : street_.first_frames) {
        if (first_frame != i) continue;
        const Eigen::Vector3d seen = street_.T_cam_world[i] * positions_.at(track) / scale;
        segment.points.push_back({track, segment.poses.back().T_cam_world.Inverse() * seen, 10, 0});
      }
    }
  }

  StreetOptions options_;
  std::mt19937 random_;
  Street street_;
  std::vector<Track> tracks_;
  std::map<std::int64_t, Eigen::Vector3d> positions_;
  std::int64_t next_id_ = 0;
  int road_tracks_ = 0;
};

}  // namespace evo::odometry::testing
