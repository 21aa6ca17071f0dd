#pragma once

#include <map>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "odometry/bundle/refined_points.hpp"
#include "odometry/frontend/frame.hpp"
#include "odometry/segment.hpp"

namespace evo::odometry {

/// Completes the poses of an adjusted bundle by those of all other frames against the refined points: frames between
/// the bundle's, whether the tracking has lost them or not, and the frames before and after, as far as they can be
/// tracked.
class PoseCompleter {
 public:
  /// The points have errors in common as tracks do: the covariances of single poses are multiplied by
  /// `variance_inflation`. The other arguments must outlive this object.
  PoseCompleter(const std::vector<Frame>& frames, const RefinedPoints& points, double variance_inflation)
      : frames_(frames), points_(points), variance_inflation_(variance_inflation) {}

  /// Adds a pose of the bundle, which stays as it is.
  void AddAdjusted(int frame, const geometry::SE3& T_cam_world);

  /// Estimates and adds the pose of a frame from that of a frame nearby; false if too few points agree.
  bool AddEstimated(int frame, const geometry::SE3& T_cam_world_initial, double min_inlier_ratio);

  /// Adds the poses of the frames from `frame` up to but without `end` in steps of `direction`, until one cannot be
  /// estimated or is far more uncertain than the typical one: a first pose estimated from a few young tracks would
  /// rotate the whole path.
  void Extend(int frame, int end, int direction, geometry::SE3 T_cam_world_initial);

  /// In order of time.
  std::vector<SegmentPose> Poses() const;
  /// Indices of the adjusted poses in Poses().
  std::vector<std::size_t> AdjustedPoses() const;
  /// Covariance of every pose relative to the points, of its left twist; zero for the adjusted ones.
  std::vector<geometry::Matrix6d> Covariances() const;

 private:
  struct Pose {
    SegmentPose pose;
    geometry::Matrix6d covariance;
    bool is_adjusted = false;
  };

  const std::vector<Frame>& frames_;
  const RefinedPoints& points_;
  double variance_inflation_;
  std::map<int, Pose> poses_;            // by frame
  std::vector<double> rotation_sigmas_;  // of all poses relative to the points, rad
};

}  // namespace evo::odometry
