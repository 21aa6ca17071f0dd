#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "evaluation/tracks/depth_reprojection.hpp"
#include "evaluation/tracks/sensor_fit.hpp"
#include "evo/core/error.hpp"
#include "evo/evaluation/track_truth.hpp"

namespace evo::evaluation {

namespace {

constexpr TimeNs kMaxMapDelay = kNsPerSecond / 10;  // a map farther away in time may show another surface

/// A point that is followed through the depth maps.
struct FollowedPoint {
  std::size_t track = 0;
  std::optional<std::size_t> other_surface;  ///< index in TrueTrack::other_surfaces; empty for the track's own point
  Eigen::Vector3d position_world;
  TimeNs last_visible = 0;
};

/// Indices of the tracks that start nearest to each map.
std::vector<std::vector<std::size_t>> FindStarts(const std::vector<FeatureTrack>& tracks,
                                                 const std::vector<TimeNs>& stamps) {
  std::vector<std::vector<std::size_t>> starts(stamps.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const TimeNs t = tracks[i].observations.front().t;
    auto nearest = std::ranges::lower_bound(stamps, t);
    if (nearest == stamps.end() || (nearest != stamps.begin() && t - *(nearest - 1) <= *nearest - t)) --nearest;
    if (std::abs(*nearest - t) <= kMaxMapDelay) starts[static_cast<std::size_t>(nearest - stamps.begin())].push_back(i);
  }
  return starts;
}

/// Follows all visible points through the maps in order of time, so that each map is read at most once.
class PointFollower {
 public:
  PointFollower(const std::vector<FeatureTrack>& tracks, const DepthReprojection& reprojection,
                std::vector<TrueTrack>* results)
      : tracks_(tracks), reprojection_(reprojection), results_(*results) {}

  bool idle() const { return points_.empty(); }

  void Start(const std::vector<std::size_t>& starting, const DepthView& view) {
    for (const std::size_t track : starting) {
      const auto& first = tracks_[track].observations.front();
      const auto T_cam_world = reprojection_.CameraAt(first.t);
      if (!T_cam_world) continue;
      const auto position = reprojection_.IntersectSurface(first, *T_cam_world, view);
      if (!position) continue;
      TrueTrack& result = results_[track];
      if (reprojection_.IsNearMovingObject(*position, view)) {
        result.status = TrackStatus::kMovingObject;
        continue;
      }
      result.status = TrackStatus::kEvaluated;
      points_.push_back({track, std::nullopt, *position, first.t});
      for (const auto& other : reprojection_.IntersectOtherSurfaces(*position, *T_cam_world, view)) {
        points_.push_back({track, result.other_surfaces.size(), other, first.t});
        result.other_surfaces.emplace_back(tracks_[track].observations.size());
      }
    }
  }

  void CheckOcclusion(const DepthView& view) {
    std::erase_if(points_, [&](const FollowedPoint& point) {
      const bool occluded =
          !point.other_surface && point.last_visible < view.t && reprojection_.IsOccluded(point.position_world, view);
      if (occluded) End(point, point.last_visible);
      return occluded;
    });
  }

  void CheckInImage(TimeNs t) {
    std::erase_if(points_, [&](FollowedPoint& point) {
      if (point.last_visible >= t) return false;
      const bool in_image = reprojection_.ProjectAt(point.position_world, t).has_value();
      if (!in_image) End(point, reprojection_.LastTimeInImage(point.position_world, point.last_visible, t));
      point.last_visible = t;
      return !in_image;
    });
  }

  void EndAll() {
    for (const FollowedPoint& point : points_) End(point, point.last_visible);
    points_.clear();
  }

 private:
  void End(const FollowedPoint& point, TimeNs until) {
    TrueTrack& result = results_[point.track];
    if (!point.other_surface) result.visible_until = until;
    auto& positions = point.other_surface ? result.other_surfaces[*point.other_surface] : result.positions;
    const auto& observations = tracks_[point.track].observations;
    for (std::size_t i = 0; i < observations.size() && observations[i].t <= until; ++i) {
      positions[i] = reprojection_.ProjectAt(point.position_world, observations[i].t);
    }
  }

  const std::vector<FeatureTrack>& tracks_;
  const DepthReprojection& reprojection_;
  std::vector<TrueTrack>& results_;
  std::vector<FollowedPoint> points_;
};

void CheckSize(const io::DepthMapReader& maps, const geometry::Camera& camera) {
  if (maps.width() == camera.width() && maps.height() == camera.height() && maps.width() > 1 && maps.height() > 1) {
    return;
  }
  throw Error(ErrorKind::kInput,
              fmt::format("the depth maps of {} x {} px do not belong to the calibrated {} x {} sensor", maps.width(),
                          maps.height(), camera.width(), camera.height()));
}

}  // namespace

std::vector<TrueTrack> TruthFromDepth(const std::vector<FeatureTrack>& tracks, const geometry::Trajectory& trajectory,
                                      const geometry::Camera& camera, const io::DepthMapReader& maps, TimeNs max_gap,
                                      const TrackTruthOptions& options) {
  CheckSize(maps, camera);
  CheckSensorFit(tracks, camera);
  const DepthReprojection reprojection(trajectory, camera, max_gap, options);
  std::vector<TrueTrack> results(tracks.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const auto& observations = tracks[i].observations;
    const bool has_pose = reprojection.CameraAt(observations.front().t).has_value();
    results[i].status = has_pose ? TrackStatus::kNoDepth : TrackStatus::kNoTruth;  // until it starts
    results[i].positions.resize(observations.size());
    results[i].starts_at_observation = true;
  }
  PointFollower follower(tracks, reprojection, &results);
  const auto starts = FindStarts(tracks, maps.stamps());
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const TimeNs t = maps.stamps()[i];
    const auto T_cam_world = reprojection.CameraAt(t);
    if (!T_cam_world || (starts[i].empty() && follower.idle())) continue;
    const DepthView view{t, *T_cam_world, maps.Read(i)};
    follower.CheckOcclusion(view);
    follower.Start(starts[i], view);
    follower.CheckInImage(t);
  }
  if (!trajectory.empty()) {
    follower.CheckInImage(std::min(trajectory.back().t, maps.stamps().back() + kMaxMapDelay));
  }
  follower.EndAll();
  return results;
}

}  // namespace evo::evaluation
