#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "evo/odometry/odometry_options.hpp"
#include "odometry/frontend/bootstrap.hpp"
#include "odometry/frontend/frame.hpp"
#include "odometry/frontend/pose_optimizer.hpp"
#include "odometry/mapping/mapper.hpp"
#include "odometry/mapping/mapping_thread.hpp"

namespace evo::odometry {

/// What became of one frame.
struct FrameRecord {
  int segment = -1;    ///< of the map that it was tracked in; -1: it has no pose
  int reference = -1;  ///< key frame that the pose is relative to
  geometry::SE3 T_cam_reference;
  int inliers = 0;
};

/// The centre of the odometry: bootstraps, tracks frame by frame, chooses key frames, feeds the depth thread, and
/// starts a new segment of the map after a loss.
class FrameHandler {
 public:
  /// `frames` outlives this object. `threads` > 1 gives the mapping a thread of its own.
  FrameHandler(const FrameHandlerOptions& options, const std::vector<Frame>& frames, double focal_px, int threads);

  /// Works through all frames. `progress` gets the share of the work done.
  void Run(const std::function<void(double)>& progress);

  const std::vector<FrameRecord>& records() const { return records_; }
  /// T_cam_world of a frame that has a pose.
  geometry::SE3 Pose(int index) const;
  const std::vector<int>& key_frames() const { return key_indices_; }
  const std::vector<int>& bootstraps() const { return bootstraps_; }
  const std::vector<int>& losses() const { return losses_; }
  /// Complete after Run(): all points of all segments.
  std::vector<Point> Points() const;
  /// Why there is no (new) map yet.
  const std::string& obstacle() const { return bootstrapper_.obstacle(); }

 private:
  struct Sighted {
    std::vector<std::int64_t> tracks;
    std::vector<PoseObservation> observations;
  };
  void Step(int index);
  void Apply(int index);
  bool Track(int index);
  Sighted Sight(const Frame& frame) const;
  geometry::SE3 Predict(TimeNs t) const;
  void Commit(int index, const Sighted& sighted, const PoseEstimate& estimate);
  bool IsKeyFrame(int index, const geometry::SE3& T_cam_world, const Sighted& sighted) const;
  void StartSegment(Bootstrap bootstrap);
  void PlaceSegment(Bootstrap* bootstrap) const;
  void Remember(int index, const geometry::SE3& T_cam_world, bool key_frame, int inliers, FrameMessage* message);

  FrameHandlerOptions options_;
  const std::vector<Frame>& frames_;
  PoseOptimizer optimizer_;
  Bootstrapper bootstrapper_;
  Mapper mapper_;
  std::unordered_map<std::int64_t, Eigen::Vector3d> landmarks_;  // the pose thread's view of the map, world
  std::vector<geometry::SE3> key_poses_;                         // T_cam_world
  std::vector<int> key_indices_;                                 // of the frames
  std::vector<FrameRecord> records_;
  std::vector<int> bootstraps_;
  std::vector<int> losses_;
  bool tracking_ = false;
  int last_ = -1;          // the last frame with a pose
  int before_last_ = -1;   // the one before, in the same segment; -1 at its beginning
  MappingThread mapping_;  // last: its thread ends before what it works on
};

}  // namespace evo::odometry
