#include "evo/evaluation/track_truth.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "evaluation/tracks/sensor_fit.hpp"
#include "evo/geometry/triangulation.hpp"

namespace evo::evaluation {

namespace {

constexpr std::size_t kMinViews = 3;  // two views leave one residual for three unknowns

/// Linear interpolation; empty outside the track and in gaps longer than `max_gap`.
std::optional<Eigen::Vector2d> PositionAt(const std::vector<events::TrackObservation>& track, TimeNs t,
                                          TimeNs max_gap) {
  const auto after = std::ranges::lower_bound(track, t, {}, &events::TrackObservation::t);
  if (after == track.end()) return std::nullopt;
  const Eigen::Vector2d next(after->x, after->y);
  if (after->t == t) return next;
  if (after == track.begin()) return std::nullopt;
  const auto before = after - 1;
  const TimeNs gap = after->t - before->t;
  if (gap > max_gap) return std::nullopt;
  const double s = ToSeconds(t - before->t) / ToSeconds(gap);
  return Eigen::Vector2d((1.0 - s) * Eigen::Vector2d(before->x, before->y) + s * next);
}

TrueTrack Triangulate(const FeatureTrack& track, const geometry::Trajectory& trajectory, const geometry::Camera& camera,
                      TimeNs max_gap) {
  TrueTrack result;
  result.positions.resize(track.observations.size());
  std::vector<geometry::View> views;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < track.observations.size(); ++i) {
    const auto& observation = track.observations[i];
    const auto T_world_cam = geometry::PoseAt(trajectory, observation.t, max_gap);
    const auto x = camera.Undistort({observation.x, observation.y});
    if (!T_world_cam || !x) continue;
    views.push_back({T_world_cam->Inverse(), *x});
    indices.push_back(i);
  }
  if (views.empty()) return result;
  result.status = TrackStatus::kTooShort;
  if (views.size() < kMinViews) return result;
  result.status = TrackStatus::kNotTriangulated;
  const auto point = geometry::TriangulateViews(views);
  if (!point) return result;
  result.status = TrackStatus::kEvaluated;
  for (std::size_t i = 0; i < views.size(); ++i) {
    result.positions[indices[i]] = camera.Project(views[i].T_cam_world * point->position_world);
  }
  return result;
}

}  // namespace

std::vector<FeatureTrack> GroupById(const events::Tracks& tracks) {
  std::map<std::int64_t, std::vector<events::TrackObservation>> by_id;
  for (const auto& observation : tracks) by_id[observation.id].push_back(observation);
  std::vector<FeatureTrack> grouped;
  grouped.reserve(by_id.size());
  for (auto& [id, observations] : by_id) grouped.push_back({id, std::move(observations)});
  return grouped;
}

std::vector<TrueTrack> TruthFromTracks(const std::vector<FeatureTrack>& tracks, const events::Tracks& truth,
                                       TimeNs max_gap) {
  const auto true_tracks = GroupById(truth);
  std::vector<TrueTrack> results;
  for (const auto& [id, observations] : tracks) {
    TrueTrack& result = results.emplace_back();
    result.positions.resize(observations.size());
    const auto found = std::ranges::lower_bound(true_tracks, id, {}, &FeatureTrack::id);
    if (found == true_tracks.end() || found->id != id) continue;
    for (std::size_t i = 0; i < observations.size(); ++i) {
      result.positions[i] = PositionAt(found->observations, observations[i].t, max_gap);
      if (result.positions[i]) result.status = TrackStatus::kEvaluated;
    }
    result.visible_until = found->observations.back().t;
  }
  return results;
}

std::vector<TrueTrack> TruthFromTriangulation(const std::vector<FeatureTrack>& tracks,
                                              const geometry::Trajectory& trajectory, const geometry::Camera& camera,
                                              TimeNs max_gap) {
  CheckSensorFit(tracks, camera);
  std::vector<TrueTrack> results;
  results.reserve(tracks.size());
  for (const auto& track : tracks) results.push_back(Triangulate(track, trajectory, camera, max_gap));
  return results;
}

}  // namespace evo::evaluation
