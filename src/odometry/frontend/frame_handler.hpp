#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "evo/odometry/odometry_options.hpp"
#include "evo/odometry/odometry_result.hpp"
#include "odometry/frontend/bootstrap.hpp"
#include "odometry/frontend/frame.hpp"
#include "odometry/frontend/pose_optimizer.hpp"
#include "odometry/mapping/mapper.hpp"
#include "odometry/mapping/mapping_thread.hpp"
#include "odometry/mapping/segment_alignment.hpp"

namespace evo::odometry {

/// The result of one frame.
struct FrameRecord {
  int segment = -1;   ///< index of its segment; -1: it has no pose
  KeyFramePose pose;  ///< so that it follows the refinement of the key frame
  int inliers = 0;    ///< points that agree with the pose
};

/// The pose thread and the centre of the odometry: bootstraps, tracks frame by frame, selects key frames, feeds the
/// depth thread, and starts a new segment of the map after a loss.
class FrameHandler {
 public:
  /// `frames` outlives this object. With `threads` > 1 the mapping has a thread of its own.
  FrameHandler(const FrameHandlerOptions& options, const std::vector<Frame>& frames, double focal_px, int threads);

  /// Processes all frames. `progress` gets the ratio that is done.
  void Run(const std::function<void(double)>& progress);
  /// In place of Run(): tracks the frames after those of `map` against it, until the pose is lost for a while. The map
  /// need not begin at the first frame.
  void Continue(const Bootstrap& map);

  const std::vector<FrameRecord>& records() const { return records_; }
  /// T_cam_world of a frame that has a pose.
  geometry::SE3 Pose(int index) const;
  const std::vector<int>& key_frames() const { return key_frames_; }
  /// First frames of all segments.
  const std::vector<int>& bootstraps() const { return bootstraps_; }
  /// Last frame of the first map.
  int first_map_end() const { return first_map_end_; }
  /// Where the pose was lost, in order of time.
  const std::vector<TrackingLoss>& losses() const { return losses_; }
  /// The points of all segments, complete after Run().
  std::vector<Point> Points() const;
  /// Why there is no map yet, for the user.
  const std::string& failure_reason() const { return bootstrapper_.failure_reason(); }

 private:
  /// The features of a frame whose tracks have a landmark.
  struct LandmarkMatches {
    std::vector<std::int64_t> tracks;
    std::vector<PoseObservation> observations;
  };
  /// The motion between the last two tracked frames.
  struct LastMotion {
    geometry::Vector6d twist;  ///< left, of T_cam_world
    double interval_s;
  };

  void ProcessFrame(int index);
  /// Applies the map updates of all frames up to `index`.
  void ApplyMapUpdates(int index);
  /// Estimates and records the pose; otherwise says in `last_failure_` what the frame offered.
  bool TrackFrame(int index);
  LandmarkMatches MatchLandmarks(const Frame& frame) const;
  /// Empty at the beginning of a segment.
  std::optional<LastMotion> MeasureLastMotion() const;
  /// The pose at `t` by constant velocity.
  geometry::SE3 PredictPose(TimeNs t) const;
  bool IsKeyFrame(int index, const geometry::SE3& T_cam_world, const LandmarkMatches& matches) const;
  void StartSegment(const Bootstrap& bootstrap);
  /// Where a new segment lies in the world, by its shared tracks with the map or else by the last velocity.
  Similarity AlignSegment(const Bootstrap& bootstrap) const;
  /// Records a frame's pose relative to the newest key frame, makes the frame a key frame if `message` says so, and
  /// completes and posts the message.
  void RecordPose(int index, const geometry::SE3& T_cam_world, int inliers, FrameMessage message);

  FrameHandlerOptions options_;
  const std::vector<Frame>& frames_;
  PoseOptimizer optimizer_;
  Bootstrapper bootstrapper_;
  Mapper mapper_;
  std::unordered_map<std::int64_t, Eigen::Vector3d>
      landmarks_;                         // the map's points as the pose thread knows them, world
  std::vector<geometry::SE3> key_poses_;  // T_cam_world of the key frames
  std::vector<int> key_frames_;           // indices of the frames
  std::vector<FrameRecord> records_;
  std::vector<int> bootstraps_;
  int first_map_end_ = -1;
  std::vector<TrackingLoss> losses_;
  TrackingLoss last_failure_;
  bool tracking_ = false;
  int last_tracked_ = -1;      // the last frame with a pose
  int previous_tracked_ = -1;  // the one before in the same segment; -1 at its beginning
  MappingThread mapping_;      // last, so that its thread ends before the objects that it uses
};

}  // namespace evo::odometry
