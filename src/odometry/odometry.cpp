#include "evo/odometry/odometry.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <set>

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

constexpr int kMinFirstInliers = 20;  // of the first pose, whose error turns the whole path

void LogTracks(bool resampled, const ResamplingOptions& options) {
  if (resampled) {
    spdlog::info("odometry: asynchronous tracks, resampled every {} s", options.frame_interval_s);
  } else {
    spdlog::info("odometry: the tracks come in frames and are used as they are");
  }
}

/// The segments of the run with the poses of the tracking. The last one holds the points of all.
std::vector<Segment> CutSegments(const FrameHandler& handler) {
  std::vector<Segment> segments(handler.bootstraps().size());
  for (std::size_t i = 0; i < handler.records().size(); ++i) {
    const FrameRecord& record = handler.records()[i];
    if (record.segment < 0) continue;
    const int frame = static_cast<int>(i);
    segments[record.segment].poses.push_back({frame, handler.Pose(frame), record.inliers});
  }
  segments.back().points = handler.Points();
  return segments;
}

/// Tracks the frames before the run's first map backwards from it, since a map can only start where the camera moves
/// far enough. Adds their poses and new points to the first segment.
void ExtendBackwards(const FrameHandlerOptions& options, const std::vector<Frame>& frames, double focal_px, int threads,
                     const FrameHandler& handler, std::vector<Segment>* segments) {
  std::vector<SegmentPose>& poses = segments->front().poses;
  const int first = poses.front().frame;
  if (first == 0) return;
  // The frames of the first map, which overlap, and all before, in reverse order.
  const int last = handler.first_map_end();
  const std::vector<Frame> reversed(std::make_reverse_iterator(frames.begin() + last + 1),
                                    std::make_reverse_iterator(frames.begin()));
  Bootstrap map{0, last - first, {}, {}};
  std::set<std::int64_t> tracks;
  for (int frame = last; frame >= first; --frame) {
    map.T_cam_world.push_back(handler.Pose(frame));
    for (const Feature& feature : frames[frame].features) tracks.insert(feature.track);
  }
  std::vector<Point>& points = segments->back().points;
  std::ranges::copy_if(points, std::back_inserter(map.points),
                       [&](const Point& point) { return tracks.contains(point.track); });
  FrameHandler backward(options, reversed, focal_px, threads);
  backward.Continue(map);

  std::vector<SegmentPose> earlier;
  for (int frame = 0; frame < first; ++frame) {
    const FrameRecord& record = backward.records()[last - frame];
    if (record.segment < 0) continue;
    if (earlier.empty() && record.inliers < kMinFirstInliers) continue;
    earlier.push_back({frame, backward.Pose(last - frame), record.inliers});
  }
  poses.insert(poses.begin(), earlier.begin(), earlier.end());
  std::set<std::int64_t> known;
  for (const Point& point : points) known.insert(point.track);
  std::ranges::copy_if(backward.Points(), std::back_inserter(points),
                       [&](const Point& point) { return !known.contains(point.track); });
  spdlog::info("odometry: tracked backwards from the first map: {} of {} frames", earlier.size(), first);
}

/// The motion of the world by which the refinement of a segment moved its last frame with a pose before and after.
geometry::SE3 EndCorrection(const std::vector<SegmentPose>& old_poses, const std::vector<SegmentPose>& poses) {
  for (std::size_t old = old_poses.size(); old-- > 0;) {
    const auto found = std::ranges::lower_bound(poses, old_poses[old].frame, {}, &SegmentPose::frame);
    if (found == poses.end() || found->frame != old_poses[old].frame) continue;
    return found->T_cam_world.Inverse() * old_poses[old].T_cam_world;
  }
  return {};
}

/// Refines every segment and moves those after it with its end.
void RefineSegments(const FinalRefinementOptions& options, const std::vector<Frame>& frames,
                    const std::function<void(double)>& progress, ThreadPool* pool, std::vector<Segment>* segments) {
  geometry::SE3 T_new_world;  // of the world
  int begin_frame = 0;
  const double count = static_cast<double>(segments->size());
  for (std::size_t i = 0; i < segments->size(); ++i) {
    Segment& segment = (*segments)[i];
    for (SegmentPose& pose : segment.poses) pose.T_cam_world = pose.T_cam_world * T_new_world.Inverse();
    for (Point& point : segment.points) point.position = T_new_world * point.position;
    const std::vector<SegmentPose> old_poses = segment.poses;
    const int end_frame =
        i + 1 < segments->size() ? (*segments)[i + 1].poses.front().frame : static_cast<int>(frames.size());
    const auto segment_progress = [&](double ratio) { progress((static_cast<double>(i) + ratio) / count); };
    RefineSegment(options, frames, begin_frame, end_frame, segment_progress, pool, &segment);
    T_new_world = EndCorrection(old_poses, segment.poses) * T_new_world;
    begin_frame = segment.poses.back().frame + 1;
  }
}

/// The covariance of the camera's position and rotation along the world's axes, from that of the left twist of
/// T_cam_world.
geometry::Matrix6d RotateToWorld(const geometry::SE3& T_cam_world, const geometry::Matrix6d& covariance) {
  geometry::Matrix6d rotation = geometry::Matrix6d::Zero();
  rotation.topLeftCorner<3, 3>() = rotation.bottomRightCorner<3, 3>() = T_cam_world.Inverse().RotationMatrix();
  return rotation * covariance * rotation.transpose();
}

void CollectSegment(const Segment& segment, const std::vector<Frame>& frames, OdometryResult* result) {
  const bool scale_is_free = !result->ground || !result->ground->metric;
  const auto covariances = segment.uncertainty.Covariances(scale_is_free);
  for (std::size_t i = 0; i < segment.poses.size(); ++i) {
    const SegmentPose& pose = segment.poses[i];
    result->trajectory.push_back({frames[pose.frame].t, pose.T_cam_world.Inverse()});
    result->inliers.push_back(pose.inliers);
    if (covariances.empty()) continue;
    result->covariances.push_back({frames[pose.frame].t, RotateToWorld(pose.T_cam_world, covariances[i])});
  }
  result->points.insert(result->points.end(), segment.points.begin(), segment.points.end());
}

/// Stamps of the frames without a pose between the first and the last pose.
std::vector<TimeNs> FindLostFrames(const std::vector<Frame>& frames, const geometry::Trajectory& trajectory) {
  std::vector<TimeNs> lost;
  auto pose = trajectory.begin();
  for (const Frame& frame : frames) {
    if (pose == trajectory.end()) break;
    if (pose->t == frame.t) {
      ++pose;
    } else if (pose != trajectory.begin()) {
      lost.push_back(frame.t);
    }
  }
  return lost;
}

}  // namespace

OdometryResult RunOdometry(const events::Tracks& tracks, const geometry::Camera& camera, const OdometryOptions& options,
                           int threads, const OdometryProgress& progress) {
  OdometryResult result;
  result.resampled = !AreSynchronous(tracks);
  LogTracks(result.resampled, options.resampling);
  const std::vector<Frame> frames =
      BuildFrames(result.resampled ? Resample(tracks, options.resampling) : tracks, camera);
  result.frames = static_cast<int>(frames.size());

  FrameHandler handler(options.frame_handler, frames, camera.focal_px(), threads);
  handler.Run([&](double ratio) { progress(OdometryStage::kFrames, ratio); });  // equations 1-13
  if (handler.bootstraps().empty()) {
    throw Error(ErrorKind::kTrackingLost, fmt::format("no pair of the {} frames could start a map; at the end: {}",
                                                      frames.size(), handler.failure_reason()));
  }
  result.key_frames = static_cast<int>(handler.key_frames().size());
  for (const int index : handler.bootstraps()) result.bootstraps.push_back(frames[index].t);
  result.losses = handler.losses();

  std::vector<Segment> segments = CutSegments(handler);
  if (options.backward_tracking) {
    ExtendBackwards(options.frame_handler, frames, camera.focal_px(), threads, handler, &segments);
  }
  if (options.final_refinement.enabled) {
    ThreadPool pool(threads);
    const auto refinement_progress = [&](double ratio) { progress(OdometryStage::kRefinement, ratio); };
    RefineSegments(options.final_refinement, frames, refinement_progress, &pool, &segments);
  }
  if (options.ground.hold_height || options.ground.camera_height_m > 0.0) {
    result.ground = ScaleByGround(options.ground, frames, &segments);
  }
  for (const Segment& segment : segments) CollectSegment(segment, frames, &result);
  result.lost = FindLostFrames(frames, result.trajectory);
  return result;
}

}  // namespace evo::odometry
