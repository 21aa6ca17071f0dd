#include "odometry/frontend/frame_handler.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "odometry/mapping/segment_alignment.hpp"

namespace evo::odometry {

namespace {

constexpr double kPredictionSeconds = 0.5;  // a velocity older than this says nothing
constexpr int kHighIndex = std::numeric_limits<int>::max();

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
    Step(index);
    progress(static_cast<double>(index + 1) / count);
  }
  Apply(kHighIndex);
}

geometry::SE3 FrameHandler::Pose(int index) const {
  const FrameRecord& record = records_[index];
  return record.T_cam_reference * key_poses_[record.reference];
}

std::vector<Point> FrameHandler::Points() const {
  std::vector<Point> points = mapper_.finished();
  for (const auto& [track, point] : mapper_.map().points) points.push_back(point);
  return points;
}

void FrameHandler::Step(int index) {
  Apply(index - options_.lag);
  if (last_ >= 0 && Track(index)) {
    if (!tracking_) spdlog::info("odometry: found the map again at {} s", FormatTime(frames_[index].t));
    tracking_ = true;
    return;
  }
  if (tracking_) {
    spdlog::warn("odometry: lost at {} s", FormatTime(frames_[index].t));
    losses_.push_back(index);
    tracking_ = false;
    bootstrapper_.Reset();
  }
  if (auto bootstrap = bootstrapper_.Add(index)) StartSegment(std::move(*bootstrap));
}

void FrameHandler::Apply(int index) {
  for (const MapUpdate& update : mapping_.Collect(index)) {
    for (const auto& [track, position] : update.points) landmarks_[track] = position;
    for (const auto track : update.removed) landmarks_.erase(track);
    for (const auto& [key, pose] : update.key_frames) key_poses_[key] = pose;
  }
}

FrameHandler::Sighted FrameHandler::Sight(const Frame& frame) const {
  Sighted sighted;
  for (const Feature& feature : frame.features) {
    const auto found = landmarks_.find(feature.track);
    if (found == landmarks_.end()) continue;
    sighted.tracks.push_back(feature.track);
    sighted.observations.push_back({found->second, feature.x, feature.J_pixel_normalized});
  }
  return sighted;
}

/// The last pose carried on with the last velocity.
geometry::SE3 FrameHandler::Predict(TimeNs t) const {
  geometry::SE3 last = Pose(last_);
  const double ahead = ToSeconds(t - frames_[last_].t);
  if (before_last_ < 0 || ahead > kPredictionSeconds) return last;
  const double interval = ToSeconds(frames_[last_].t - frames_[before_last_].t);
  const geometry::Vector6d step = (last * Pose(before_last_).Inverse()).Log();
  return geometry::SE3::Exp(ahead / interval * step) * last;
}

bool FrameHandler::Track(int index) {
  const Sighted sighted = Sight(frames_[index]);
  PoseEstimate estimate = optimizer_.Optimize(sighted.observations, Predict(frames_[index].t));
  if (!optimizer_.Accepts(estimate)) estimate = optimizer_.Optimize(sighted.observations, Pose(last_));
  if (!optimizer_.Accepts(estimate)) return false;
  Commit(index, sighted, estimate);
  return true;
}

void FrameHandler::Commit(int index, const Sighted& sighted, const PoseEstimate& estimate) {
  FrameMessage message;
  for (std::size_t i = 0; i < sighted.tracks.size(); ++i) {
    (estimate.inliers[i] ? message.inliers : message.outliers).push_back(sighted.tracks[i]);
  }
  const bool key_frame = IsKeyFrame(index, estimate.T_cam_world, sighted);
  Remember(index, estimate.T_cam_world, key_frame, estimate.inlier_count, &message);
  mapping_.Post(std::move(message));
}

/// Records the pose of a frame relative to the newest key frame, and makes it one itself if asked to.
void FrameHandler::Remember(int index, const geometry::SE3& T_cam_world, bool key_frame, int inliers,
                            FrameMessage* message) {
  message->index = index;
  message->frame = frames_[index];
  message->key_frame = key_frame;
  message->reference = message->new_segment ? -1 : static_cast<int>(key_poses_.size()) - 1;
  message->T_cam_reference =
      message->new_segment ? T_cam_world : T_cam_world * key_poses_[message->reference].Inverse();
  records_[index] = {static_cast<int>(bootstraps_.size()) - 1, message->reference, message->T_cam_reference, inliers};
  if (key_frame) {
    key_poses_.push_back(T_cam_world);
    key_indices_.push_back(index);
    records_[index].reference = static_cast<int>(key_poses_.size()) - 1;
    records_[index].T_cam_reference = geometry::SE3();
  }
  before_last_ = message->new_segment ? -1 : last_;
  last_ = index;
}

bool FrameHandler::IsKeyFrame(int index, const geometry::SE3& T_cam_world, const Sighted& sighted) const {
  const auto& options = options_.key_frame;
  if (options.every_frames > 0) return index - key_indices_.back() >= options.every_frames;
  const Frame& frame = frames_[index];
  const auto shared = Match(frames_[key_indices_.back()], frame);
  const double disparity = MedianDisparity(shared);
  if (!shared.empty() && disparity < options.min_disparity_px) return false;
  if (disparity > options.disparity_px) return true;
  if (static_cast<double>(shared.size()) < options.min_shared_ratio * static_cast<double>(frame.features.size())) {
    return true;
  }
  const geometry::SE3 motion = T_cam_world * key_poses_.back().Inverse();
  if (geometry::so3::Log(motion.rotation()).norm() > options.rotation_deg * std::numbers::pi / 180.0) return true;
  std::vector<double> depths;
  for (const auto& observation : sighted.observations) {
    const double z = (T_cam_world * observation.point_world).z();
    if (z > 0.0) depths.push_back(z);
  }
  return motion.translation().norm() > options.translation * MeasureSceneDepth(std::move(depths)).median;
}

void FrameHandler::StartSegment(Bootstrap bootstrap) {
  Apply(kHighIndex);  // nothing of the old segment may arrive in the new one
  if (last_ >= 0) PlaceSegment(&bootstrap);
  bootstraps_.push_back(bootstrap.first);
  spdlog::info("odometry: map of {} points from the frames at {} s and {} s", bootstrap.points.size(),
               FormatTime(frames_[bootstrap.first].t), FormatTime(frames_[bootstrap.last].t));
  landmarks_.clear();
  for (const Point& point : bootstrap.points) landmarks_[point.track] = point.position;
  for (int index = bootstrap.first; index <= bootstrap.last; ++index) {
    FrameMessage message;
    const bool first = index == bootstrap.first;
    message.new_segment = first;
    if (first) message.points = bootstrap.points;
    Remember(index, bootstrap.T_cam_world[index - bootstrap.first], first || index == bootstrap.last,
             static_cast<int>(Sight(frames_[index]).tracks.size()), &message);
    mapping_.Post(std::move(message));
  }
  tracking_ = true;
}

/// Moves and scales a new segment so that it continues the old one.
void FrameHandler::PlaceSegment(Bootstrap* bootstrap) const {
  auto similarity = AlignByPoints(bootstrap->points, landmarks_);
  if (similarity) {
    spdlog::info("odometry: the new segment takes place and scale from tracks seen across the gap");
  } else {
    const TimeNs t = frames_[bootstrap->first].t;
    double speed = 0.0;
    geometry::SE3 start = Pose(last_);
    if (before_last_ >= 0) {
      const geometry::Vector6d step = (start * Pose(before_last_).Inverse()).Log();
      const double interval = ToSeconds(frames_[last_].t - frames_[before_last_].t);
      speed = step.head<3>().norm() / interval;
      start = geometry::SE3::Exp(ToSeconds(t - frames_[last_].t) / interval * step) * start;
    }
    double path = 0.0;
    for (std::size_t i = 1; i < bootstrap->T_cam_world.size(); ++i) {
      path +=
          (bootstrap->T_cam_world[i].Inverse().translation() - bootstrap->T_cam_world[i - 1].Inverse().translation())
              .norm();
    }
    const double duration = ToSeconds(frames_[bootstrap->last].t - t);
    const double scale = speed > 0.0 && path > 0.0 ? speed * duration / path : 1.0;
    similarity = Similarity{scale, start.Inverse()};
    spdlog::warn("odometry: no track crosses the gap; the new segment takes place and scale from the speed before it");
  }
  Transform(*similarity, bootstrap);
}

}  // namespace evo::odometry
