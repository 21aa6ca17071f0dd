#include "evo/odometry/odometry.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>

#include "evo/core/error.hpp"
#include "evo/core/parallel.hpp"
#include "evo/odometry/resampling.hpp"
#include "odometry/bundle/final_refinement.hpp"
#include "odometry/frontend/frame_builder.hpp"
#include "odometry/frontend/frame_handler.hpp"
#include "odometry/scale/ground_scale.hpp"
#include "odometry/segment.hpp"

namespace evo::odometry {

namespace {

/// The run cut into its segments, with the poses as the tracking left them.
std::vector<Segment> CutSegments(const FrameHandler& handler) {
  std::vector<Segment> segments(handler.bootstraps().size());
  for (std::size_t i = 0; i < handler.records().size(); ++i) {
    const FrameRecord& record = handler.records()[i];
    if (record.segment < 0) continue;
    Segment& segment = segments[record.segment];
    const int frame = static_cast<int>(i);
    segment.poses.push_back({frame, handler.Pose(frame), record.inliers});
  }
  return segments;
}

/// How the refinement of a segment has moved its last frame that has had a pose before and after, in the world.
geometry::SE3 MoveOfEnd(const std::vector<SegmentPose>& old_poses, const Segment& segment) {
  for (std::size_t old = old_poses.size(); old-- > 0;) {
    const auto at = std::ranges::lower_bound(segment.poses, old_poses[old].frame, {}, &SegmentPose::frame);
    if (at == segment.poses.end() || at->frame != old_poses[old].frame) continue;
    return at->T_cam_world.Inverse() * old_poses[old].T_cam_world;
  }
  return {};
}

/// Refines every segment and carries each change of a segment's end on to those after it.
void RefineSegments(const FinalRefinementOptions& options, const std::vector<Frame>& frames,
                    const std::function<void(double)>& progress, ThreadPool* pool, std::vector<Segment>* segments) {
  geometry::SE3 T_new_old;  // of the world
  int before = 0;
  const double count = static_cast<double>(segments->size());
  for (std::size_t i = 0; i < segments->size(); ++i) {
    Segment& segment = (*segments)[i];
    for (SegmentPose& pose : segment.poses) pose.T_cam_world = pose.T_cam_world * T_new_old.Inverse();
    for (Point& point : segment.points) point.position = T_new_old * point.position;
    const std::vector<SegmentPose> old_poses = segment.poses;
    const int after =
        i + 1 < segments->size() ? (*segments)[i + 1].poses.front().frame : static_cast<int>(frames.size());
    RefineSegment(
        options, frames, before, after, [&](double share) { progress((static_cast<double>(i) + share) / count); }, pool,
        &segment);
    T_new_old = MoveOfEnd(old_poses, segment) * T_new_old;
    before = segment.poses.back().frame + 1;
  }
}

/// Of the camera in the world, from that of the left twist of T_cam_world.
geometry::Matrix6d InWorld(const geometry::SE3& T_cam_world, const geometry::Matrix6d& covariance) {
  geometry::Matrix6d turn = geometry::Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = T_cam_world.Inverse().RotationMatrix();
  return turn * covariance * turn.transpose();
}

void ListLost(const std::vector<Frame>& frames, OdometryResult* result) {
  auto pose = result->trajectory.begin();
  for (const Frame& frame : frames) {
    if (pose == result->trajectory.end()) break;
    if (pose->t == frame.t) {
      ++pose;
    } else if (pose != result->trajectory.begin()) {
      result->lost.push_back(frame.t);
    }
  }
}

}  // namespace

OdometryResult RunOdometry(const events::Tracks& tracks, const geometry::Camera& camera, const OdometryOptions& options,
                           int threads, const OdometryProgress& progress) {
  OdometryResult result;
  result.resampled = !AreSynchronous(tracks);
  if (result.resampled) {
    spdlog::info("odometry: asynchronous tracks, resampled every {} s", options.resampling.frame_interval_s);
  } else {
    spdlog::info("odometry: the tracks come in frames and are used as they are");
  }
  const std::vector<Frame> frames =
      BuildFrames(result.resampled ? Resample(tracks, options.resampling) : tracks, camera);
  result.frames = static_cast<int>(frames.size());

  FrameHandler handler(options.frame_handler, frames, camera.focal_px(), threads);
  handler.Run([&](double done) { progress(OdometryStage::kFrames, done); });
  if (handler.bootstraps().empty()) {
    throw Error(ErrorKind::kTrackingLost, "no pair of the " + std::to_string(frames.size()) +
                                              " frames could start a map; at the end: " + handler.obstacle());
  }
  std::vector<Segment> segments = CutSegments(handler);
  segments.back().points = handler.Points();
  if (options.final_refinement.enabled) {
    ThreadPool pool(threads);
    RefineSegments(
        options.final_refinement, frames, [&](double done) { progress(OdometryStage::kRefinement, done); }, &pool,
        &segments);
  }
  const bool grounded = options.ground.hold_height || options.ground.camera_height_m > 0.0;
  if (grounded) result.ground = ScaleByGround(options.ground, frames, &segments);
  const bool scale_is_free = !result.ground || !result.ground->metric;
  for (const Segment& segment : segments) {
    const auto covariances = segment.uncertainty.Covariances(scale_is_free);
    for (std::size_t i = 0; i < segment.poses.size(); ++i) {
      const SegmentPose& pose = segment.poses[i];
      result.trajectory.push_back({frames[pose.frame].t, pose.T_cam_world.Inverse()});
      result.inliers.push_back(pose.inliers);
      if (covariances.empty()) continue;
      result.covariances.push_back({frames[pose.frame].t, InWorld(pose.T_cam_world, covariances[i])});
    }
    result.points.insert(result.points.end(), segment.points.begin(), segment.points.end());
  }
  result.key_frames = static_cast<int>(handler.key_frames().size());
  for (const int index : handler.bootstraps()) result.bootstraps.push_back(frames[index].t);
  ListLost(frames, &result);
  return result;
}

}  // namespace evo::odometry
