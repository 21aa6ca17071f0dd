#include "odometry/frontend/frame_handler.hpp"

#include <spdlog/spdlog.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace evo::odometry {

namespace {

constexpr double kMaxPredictionSeconds = 0.5;  // an older velocity predicts nothing
constexpr int kAllFrames = std::numeric_limits<int>::max();

/// Length of the camera's path.
double PathLength(const std::vector<geometry::SE3>& T_cam_world) {
  double length = 0.0;
  for (std::size_t i = 1; i < T_cam_world.size(); ++i) {
    length += (T_cam_world[i].Inverse().translation() - T_cam_world[i - 1].Inverse().translation()).norm();
  }
  return length;
}

}  // namespace

FrameHandler::FrameHandler(const FrameHandlerOptions& options, const std::vector<Frame>& frames, double focal_px,
                           int threads)
    : options_(options),
      frames_(frames),
      optimizer_(options.pose),
      bootstrapper_(options.bootstrap, frames, focal_px),
      mapper_(options.mapper, 2.0 * std::atan(0.5 / focal_px)),
      records_(frames.size()),
      mapping_(&mapper_, threads > 1) {}

void FrameHandler::Run(const std::function<void(double)>& progress) {
  const int count = static_cast<int>(frames_.size());
  for (int index = 0; index < count; ++index) {
    ProcessFrame(index);
    progress(static_cast<double>(index + 1) / count);
  }
  ApplyMapUpdates(kAllFrames);
}

void FrameHandler::Continue(const Bootstrap& map) {
  StartSegment(map);
  for (int index = map.last + 1; index < static_cast<int>(frames_.size()); ++index) {
    ApplyMapUpdates(index - options_.lag);
    const double lost_s = std::abs(ToSeconds(frames_[index].t - frames_[last_tracked_].t));
    if (!TrackFrame(index) && lost_s > kMaxPredictionSeconds) break;
  }
  ApplyMapUpdates(kAllFrames);
}

geometry::SE3 FrameHandler::Pose(int index) const {
  const KeyFramePose& pose = records_[index].pose;
  return pose.T_cam_key * key_poses_[pose.key_frame];
}

std::vector<Point> FrameHandler::Points() const {
  std::vector<Point> points = mapper_.finished_points();
  for (const auto& [track, point] : mapper_.map().points) points.push_back(point);
  return points;
}

void FrameHandler::ProcessFrame(int index) {
  ApplyMapUpdates(index - options_.lag);
  if (last_tracked_ >= 0 && TrackFrame(index)) {
    if (!tracking_) spdlog::info("odometry: found the map again at {} s", FormatTime(frames_[index].t));
    tracking_ = true;
    return;
  }
  if (tracking_) {
    spdlog::warn("odometry: lost at {} s", FormatTime(frames_[index].t));
    tracking_ = false;
    losses_.push_back(last_failure_);
    bootstrapper_.Reset();
  }
  auto bootstrap = bootstrapper_.Add(index);  // equations 9-13
  if (!bootstrap) return;
  ApplyMapUpdates(kAllFrames);  // so that no update of the old segment arrives in the new one
  if (last_tracked_ >= 0) Transform(AlignSegment(*bootstrap), &*bootstrap);
  spdlog::info("odometry: map of {} points from the frames at {} s and {} s", bootstrap->points.size(),
               FormatTime(frames_[bootstrap->first].t), FormatTime(frames_[bootstrap->last].t));
  StartSegment(*bootstrap);
}

void FrameHandler::ApplyMapUpdates(int index) {
  for (const MapUpdate& update : mapping_.Collect(index)) {
    for (const auto& [track, position] : update.points) landmarks_[track] = position;
    for (const auto track : update.removed) landmarks_.erase(track);
    for (const auto& [key, pose] : update.key_frames) key_poses_[key] = pose;
  }
}

FrameHandler::LandmarkMatches FrameHandler::MatchLandmarks(const Frame& frame) const {
  LandmarkMatches matches;
  for (const Feature& feature : frame.features) {
    const auto found = landmarks_.find(feature.track);
    if (found == landmarks_.end()) continue;
    matches.tracks.push_back(feature.track);
    matches.observations.push_back({found->second, feature.x, feature.J_pixel_normalized});
  }
  return matches;
}

std::optional<FrameHandler::LastMotion> FrameHandler::MeasureLastMotion() const {
  if (previous_tracked_ < 0) return std::nullopt;
  return LastMotion{(Pose(last_tracked_) * Pose(previous_tracked_).Inverse()).Log(),
                    ToSeconds(frames_[last_tracked_].t - frames_[previous_tracked_].t)};
}

geometry::SE3 FrameHandler::PredictPose(TimeNs t) const {
  const geometry::SE3 T_cam_world_last = Pose(last_tracked_);
  const auto motion = MeasureLastMotion();
  const double ahead_s = ToSeconds(t - frames_[last_tracked_].t);
  return motion ? geometry::SE3::Exp(ahead_s / motion->interval_s * motion->twist) * T_cam_world_last
                : T_cam_world_last;
}

bool FrameHandler::TrackFrame(int index) {
  const Frame& frame = frames_[index];
  const LandmarkMatches matches = MatchLandmarks(frame);
  const geometry::SE3 T_cam_world_last = Pose(last_tracked_);
  const bool velocity_is_recent =
      std::abs(ToSeconds(frame.t - frames_[last_tracked_].t)) <= kMaxPredictionSeconds;  // time may run backwards
  PoseEstimate estimate = optimizer_.Optimize(
      matches.observations, velocity_is_recent ? PredictPose(frame.t) : T_cam_world_last);  // equations 1-5
  if (!optimizer_.Accepts(estimate)) estimate = optimizer_.Optimize(matches.observations, T_cam_world_last);
  if (!optimizer_.Accepts(estimate)) {
    last_failure_ = {frame.t, frame.features.size(), matches.tracks.size(),
                     static_cast<std::size_t>(estimate.inlier_count)};
    return false;
  }
  FrameMessage message;
  for (std::size_t i = 0; i < matches.tracks.size(); ++i) {
    (estimate.inliers[i] ? message.inliers : message.outliers).push_back(matches.tracks[i]);
  }
  message.is_key_frame = IsKeyFrame(index, estimate.T_cam_world, matches);
  RecordPose(index, estimate.T_cam_world, estimate.inlier_count, std::move(message));
  return true;
}

void FrameHandler::RecordPose(int index, const geometry::SE3& T_cam_world, int inliers, FrameMessage message) {
  message.index = index;
  message.frame = frames_[index];
  if (message.new_map) {
    message.pose = {-1, T_cam_world};
  } else {
    const int key_frame = static_cast<int>(key_poses_.size()) - 1;
    message.pose = {key_frame, T_cam_world * key_poses_[key_frame].Inverse()};
  }
  records_[index] = {static_cast<int>(bootstraps_.size()) - 1, message.pose, inliers};
  if (message.is_key_frame) {
    key_poses_.push_back(T_cam_world);
    key_frames_.push_back(index);
    records_[index].pose = {static_cast<int>(key_poses_.size()) - 1, geometry::SE3()};
  }
  previous_tracked_ = message.new_map ? -1 : last_tracked_;
  last_tracked_ = index;
  mapping_.Post(std::move(message));
}

bool FrameHandler::IsKeyFrame(int index, const geometry::SE3& T_cam_world, const LandmarkMatches& matches) const {
  const KeyFrameOptions& options = options_.key_frame;
  if (options.every_frames > 0) return index - key_frames_.back() >= options.every_frames;
  const Frame& frame = frames_[index];
  const auto shared = Match(frames_[key_frames_.back()], frame);
  const double disparity_px = MedianDisparity(shared);
  if (!shared.empty() && disparity_px < options.min_disparity_px) return false;  // the camera stands
  if (disparity_px > options.disparity_px) return true;
  if (static_cast<double>(shared.size()) < options.min_shared_ratio * static_cast<double>(frame.features.size())) {
    return true;
  }
  const geometry::SE3 T_cam_key = T_cam_world * key_poses_.back().Inverse();
  if (geometry::so3::Log(T_cam_key.rotation()).norm() > options.rotation_deg * std::numbers::pi / 180.0) return true;
  std::vector<double> depths;
  for (const auto& observation : matches.observations) {
    const double z = (T_cam_world * observation.point_world).z();
    if (z > 0.0) depths.push_back(z);
  }
  return T_cam_key.translation().norm() > options.translation * MeasureSceneDepth(std::move(depths)).median;
}

void FrameHandler::StartSegment(const Bootstrap& bootstrap) {
  if (bootstraps_.empty()) first_map_end_ = bootstrap.last;
  bootstraps_.push_back(bootstrap.first);
  landmarks_.clear();
  for (const Point& point : bootstrap.points) landmarks_[point.track] = point.position;
  for (int index = bootstrap.first; index <= bootstrap.last; ++index) {
    FrameMessage message;
    if (index == bootstrap.first) message.new_map = bootstrap.points;
    message.is_key_frame = index == bootstrap.first || index == bootstrap.last;
    RecordPose(index, bootstrap.T_cam_world[index - bootstrap.first],
               static_cast<int>(MatchLandmarks(frames_[index]).tracks.size()), std::move(message));
  }
  tracking_ = true;
}

Similarity FrameHandler::AlignSegment(const Bootstrap& bootstrap) const {
  if (const auto similarity = AlignByPoints(bootstrap.points, landmarks_)) {
    spdlog::info("odometry: the new segment takes place and scale from tracks seen across the gap");
    return *similarity;
  }
  spdlog::warn("odometry: no track crosses the gap; the new segment takes place and scale from the speed before it");
  const TimeNs t = frames_[bootstrap.first].t;
  const geometry::SE3 T_world_local = PredictPose(t).Inverse();
  const auto motion = MeasureLastMotion();
  const double speed = motion ? motion->twist.head<3>().norm() / motion->interval_s : 0.0;  // units/s
  const double path = PathLength(bootstrap.T_cam_world);
  const double duration_s = ToSeconds(frames_[bootstrap.last].t - t);
  return {speed > 0.0 && path > 0.0 ? speed * duration_s / path : 1.0, T_world_local};
}

}  // namespace evo::odometry
