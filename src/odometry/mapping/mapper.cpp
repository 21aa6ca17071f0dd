#include "odometry/mapping/mapper.hpp"

#include <algorithm>
#include <cmath>

#include "odometry/bundle/bundle_adjuster.hpp"

namespace evo::odometry {

namespace {

constexpr double kMinDepthRatio = 0.5;    // of the scene's near depth: nearest depth that a seed may take
constexpr int kFixedKeyFrames = 2;        // of the window: they fix its pose and scale
constexpr double kMaxOutlierRatio = 0.4;  // of the frames that observe a point; more: it is removed

/// The bundle problem of a window of key frames.
struct WindowProblem {
  BundleProblem problem;
  std::vector<std::int64_t> tracks;  ///< of the problem's points
};

/// Of the key frames [begin, end) and the points that at least two of them observe.
WindowProblem BuildWindowProblem(const Map& map, int begin, int end) {
  WindowProblem window;
  BundleProblem& problem = window.problem;
  problem.fixed_frames = kFixedKeyFrames;
  std::map<std::int64_t, std::vector<std::pair<int, const Feature*>>> features;  // with their frames, by track
  for (int i = begin; i < end; ++i) {
    problem.T_cam_world.push_back(map.key_frames[i].T_cam_world);
    for (const Feature& feature : map.key_frames[i].features) {
      if (map.Find(feature.track)) features[feature.track].emplace_back(i - begin, &feature);
    }
  }
  for (const auto& [track, observations] : features) {
    if (observations.size() < 2) continue;
    const int anchor = observations.front().first;
    const Eigen::Vector3d p = problem.T_cam_world[anchor] * map.points.at(track).position;
    if (!(p.z() > 0.0)) continue;
    const int id = static_cast<int>(problem.points.size());
    problem.points.push_back({anchor, Eigen::Vector3d(p.x(), p.y(), 1.0) / p.z()});
    window.tracks.push_back(track);
    for (const auto& [frame, feature] : observations) {
      problem.observations.push_back({frame, id, feature->x, feature->J_pixel_normalized});
    }
  }
  return window;
}

}  // namespace

Mapper::Mapper(const MapperOptions& options, double pixel_angle)
    : options_(options),
      filter_(options.depth_filter, pixel_angle, [this](const Seed& seed) { converged_.push_back(seed); }) {}

MapUpdate Mapper::Process(const FrameMessage& message) {
  MapUpdate update;
  update.index = message.index;
  if (message.new_map) StartSegment(message, &update);
  Frame frame = message.frame;
  const auto& [key_frame, T_cam_key] = message.pose;
  frame.T_cam_world = key_frame < 0 ? T_cam_key : T_cam_key * map_.key_frames[key_frame].T_cam_world;
  UpdateCounts(message);
  RemoveOutliers(message.outliers, &update);
  UpdateDepths(frame);  // equations 6-8
  InsertConverged(&update);
  if (message.is_key_frame) AddKeyFrame(frame, &update);
  return update;
}

void Mapper::StartSegment(const FrameMessage& message, MapUpdate* update) {
  filter_.Clear();
  segment_begin_ = static_cast<int>(map_.key_frames.size());
  last_measured_ = message.frame;
  for (const auto& [track, point] : map_.points) finished_points_.push_back(point);
  map_.points.clear();
  for (const Point& point : *message.new_map) {
    map_.points[point.track] = point;
    update->points.emplace_back(point.track, point.position);
  }
}

void Mapper::UpdateCounts(const FrameMessage& message) {
  const auto count = [&](const std::vector<std::int64_t>& tracks, int Point::*counter) {
    for (const auto track : tracks) {
      const auto found = map_.points.find(track);
      if (found != map_.points.end()) ++(found->second.*counter);
    }
  };
  count(message.inliers, &Point::inliers);
  count(message.outliers, &Point::outliers);
}

void Mapper::RemoveOutliers(const std::vector<std::int64_t>& tracks, MapUpdate* update) {
  for (const auto track : tracks) {
    const auto found = map_.points.find(track);
    if (found == map_.points.end()) continue;
    const Point& point = found->second;
    if (point.outliers < options_.max_outliers) continue;
    if (point.outliers < kMaxOutlierRatio * (point.inliers + point.outliers)) continue;
    map_.points.erase(found);
    update->removed.push_back(track);
  }
}

void Mapper::UpdateDepths(const Frame& frame) {
  // The observations of a standing camera are not the independent measurements that the filter assumes.
  if (MedianDisparity(Match(last_measured_, frame)) < options_.update_px) return;
  last_measured_ = frame;
  filter_.Update(frame, [&](int key) { return frame.T_cam_world * map_.key_frames[key].T_cam_world.Inverse(); });
}

void Mapper::InsertConverged(MapUpdate* update) {
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
  CreateSeeds(map_.key_frames.back());
  InsertConverged(update);
}

SceneDepth Mapper::DepthInFrame(const Frame& frame) const {
  std::vector<double> depths;
  for (const Feature& feature : frame.features) {
    const Point* const point = map_.Find(feature.track);
    const double z = point ? (frame.T_cam_world * point->position).z() : 0.0;
    if (z > 0.0) depths.push_back(z);
  }
  return MeasureSceneDepth(std::move(depths));
}

void Mapper::CreateSeeds(const Frame& frame) {
  const SceneDepth depth = DepthInFrame(frame);
  if (!(depth.near > 0.0)) return;
  const int newest = static_cast<int>(map_.key_frames.size()) - 1;
  Frame seeded;
  for (const Feature& feature : frame.features) {
    if (map_.Find(feature.track) || filter_.Has(feature.track)) continue;
    filter_.AddSeed(feature, newest, depth.median, kMinDepthRatio * depth.near);
    seeded.features.push_back(feature);
  }
  for (int i = newest - 1; i >= std::max(segment_begin_, newest - options_.old_key_frames); --i) {
    Frame old = map_.key_frames[i];
    std::erase_if(old.features, [&](const Feature& feature) { return !seeded.Find(feature.track); });
    filter_.Update(old, [&](int key) { return old.T_cam_world * map_.key_frames[key].T_cam_world.Inverse(); });
  }
}

void Mapper::RefineWindow(MapUpdate* update) {
  const int end = static_cast<int>(map_.key_frames.size());
  const int begin = std::max(segment_begin_, end - options_.window);
  if (end - begin <= kFixedKeyFrames) return;
  WindowProblem window = BuildWindowProblem(map_, begin, end);
  BundleProblem& problem = window.problem;
  AdjustBundle({.max_iterations = options_.window_iterations, .cauchy_width_px = options_.loss_px}, &problem);
  for (int i = begin; i < end; ++i) map_.key_frames[i].T_cam_world = problem.T_cam_world[i - begin];
  for (std::size_t p = 0; p < window.tracks.size(); ++p) {
    if (!(problem.points[p].inverse_depth.z() > 0.0)) continue;
    Point& point = map_.points[window.tracks[p]];
    point.position = WorldPosition(problem, problem.points[p]);
    update->points.emplace_back(point.track, point.position);
  }
}

}  // namespace evo::odometry
