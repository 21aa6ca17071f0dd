#include "odometry/mapping/mapper.hpp"

#include <algorithm>
#include <cmath>

#include "odometry/bundle/bundle_adjuster.hpp"

namespace evo::odometry {

namespace {

constexpr double kNearestShare = 0.5;  // of the near depth: where the seeds' range ends
constexpr int kFixedKeyFrames = 2;     // of the window: they hold its place and scale
constexpr double kOutlierShare = 0.4;  // of a point's history, to be dropped

}  // namespace

Mapper::Mapper(const MapperOptions& options, double px_angle)
    : options_(options), filter_(options.depth_filter, px_angle, [this](const Seed& s) { converged_.push_back(s); }) {}

MapUpdate Mapper::Process(const FrameMessage& message) {
  MapUpdate update;
  update.index = message.index;
  if (message.new_segment) StartSegment(message, &update);
  Frame frame = message.frame;
  frame.T_cam_world = message.reference < 0 ? message.T_cam_reference
                                            : message.T_cam_reference * map_.key_frames[message.reference].T_cam_world;
  Judge(message, &update);
  MeasureDepths(frame);
  AddConverged(&update);
  if (message.key_frame) AddKeyFrame(frame, &update);
  return update;
}

void Mapper::StartSegment(const FrameMessage& message, MapUpdate* update) {
  filter_.Clear();
  segment_begin_ = static_cast<int>(map_.key_frames.size());
  measured_ = message.frame;
  for (const auto& [track, point] : map_.points) finished_.push_back(point);
  map_.points.clear();
  for (const Point& point : message.points) {
    map_.points[point.track] = point;
    update->points.emplace_back(point.track, point.position);
  }
}

void Mapper::Judge(const FrameMessage& message, MapUpdate* update) {
  const auto count = [&](const std::vector<std::int64_t>& tracks, int Point::*counter) {
    for (const auto track : tracks) {
      const auto found = map_.points.find(track);
      if (found != map_.points.end()) ++(found->second.*counter);
    }
  };
  count(message.inliers, &Point::inliers);
  count(message.outliers, &Point::outliers);
  for (const auto track : message.outliers) {
    const auto found = map_.points.find(track);
    if (found == map_.points.end()) continue;
    const Point& point = found->second;
    if (point.outliers < options_.max_outliers) continue;
    if (point.outliers < kOutlierShare * (point.inliers + point.outliers)) continue;
    map_.points.erase(found);
    update->removed.push_back(track);
  }
}

void Mapper::MeasureDepths(const Frame& frame) {
  // Sightings of a camera that stands still would count as independent measurements although they are not.
  if (MedianDisparity(Match(measured_, frame)) < options_.update_px) return;
  measured_ = frame;
  filter_.Update(frame, [&](int key) { return frame.T_cam_world * map_.key_frames[key].T_cam_world.Inverse(); });
}

void Mapper::AddConverged(MapUpdate* update) {
  for (const Seed& seed : converged_) {
    const geometry::SE3 T_world_key = map_.key_frames[seed.key_frame].T_cam_world.Inverse();
    const Point point{seed.track, T_world_key * Eigen::Vector3d(seed.ray / seed.mu), 0, 0};
    map_.points[seed.track] = point;
    update->points.emplace_back(point.track, point.position);
  }
  converged_.clear();
}

void Mapper::AddKeyFrame(const Frame& frame, MapUpdate* update) {
  map_.key_frames.push_back(frame);
  if (options_.window_refinement) RefineWindow(update);
  const int newest = static_cast<int>(map_.key_frames.size()) - 1;
  for (int i = std::max(segment_begin_, newest - options_.window + 1); i <= newest; ++i) {
    update->key_frames.emplace_back(i, map_.key_frames[i].T_cam_world);
  }
  filter_.DropOld(newest);
  SowSeeds(map_.key_frames.back());
  AddConverged(update);
}

SceneDepth Mapper::DepthOfScene(const Frame& frame) const {
  std::vector<double> depths;
  for (const Feature& feature : frame.features) {
    const Point* const point = map_.Find(feature.track);
    const double z = point ? (frame.T_cam_world * point->position).z() : 0.0;
    if (z > 0.0) depths.push_back(z);
  }
  return MeasureSceneDepth(std::move(depths));
}

/// A seed for every feature that has neither a point nor a seed, measured with the key frames that saw it before.
void Mapper::SowSeeds(const Frame& frame) {
  const SceneDepth depth = DepthOfScene(frame);
  if (!(depth.near > 0.0)) return;
  const int newest = static_cast<int>(map_.key_frames.size()) - 1;
  Frame sown;
  for (const Feature& feature : frame.features) {
    if (map_.Find(feature.track) || filter_.Has(feature.track)) continue;
    filter_.AddSeed(feature, newest, depth.median, kNearestShare * depth.near);
    sown.features.push_back(feature);
  }
  for (int i = newest - 1; i >= std::max(segment_begin_, newest - options_.old_key_frames); --i) {
    Frame old = map_.key_frames[i];
    std::erase_if(old.features, [&](const Feature& feature) { return !sown.Find(feature.track); });
    filter_.Update(old, [&](int key) { return old.T_cam_world * map_.key_frames[key].T_cam_world.Inverse(); });
  }
}

void Mapper::RefineWindow(MapUpdate* update) {
  const int end = static_cast<int>(map_.key_frames.size());
  const int begin = std::max(segment_begin_, end - options_.window);
  if (end - begin <= kFixedKeyFrames) return;
  BundleProblem problem;
  problem.fixed_frames = kFixedKeyFrames;
  std::map<std::int64_t, std::vector<std::pair<int, const Feature*>>> sightings;
  for (int i = begin; i < end; ++i) {
    problem.T_cam_world.push_back(map_.key_frames[i].T_cam_world);
    for (const Feature& feature : map_.key_frames[i].features) {
      if (map_.Find(feature.track)) sightings[feature.track].emplace_back(i - begin, &feature);
    }
  }
  std::vector<std::int64_t> tracks;
  for (const auto& [track, seen] : sightings) {
    if (seen.size() < 2) continue;
    const int anchor = seen.front().first;
    const Eigen::Vector3d p = problem.T_cam_world[anchor] * map_.points[track].position;
    if (!(p.z() > 0.0)) continue;
    const int id = static_cast<int>(problem.points.size());
    problem.points.push_back({anchor, Eigen::Vector3d(p.x(), p.y(), 1.0) / p.z()});
    tracks.push_back(track);
    for (const auto& [frame, feature] : seen) {
      problem.observations.push_back({frame, id, feature->x, feature->J_pixel_normalized});
    }
  }
  AdjustBundle({.max_iterations = options_.window_iterations, .cauchy_width_px = options_.loss_px}, &problem);
  for (int i = begin; i < end; ++i) map_.key_frames[i].T_cam_world = problem.T_cam_world[i - begin];
  for (std::size_t p = 0; p < tracks.size(); ++p) {
    if (!(problem.points[p].inverse_depth.z() > 0.0)) continue;
    Point& point = map_.points[tracks[p]];
    point.position = WorldPosition(problem, problem.points[p]);
    update->points.emplace_back(point.track, point.position);
  }
}

}  // namespace evo::odometry
