#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "evo/odometry/point.hpp"
#include "odometry/bundle/segment_bundle.hpp"
#include "odometry/frontend/frame.hpp"
#include "odometry/frontend/pose_optimizer.hpp"
#include "odometry/segment.hpp"

namespace evo::odometry {

/// The points of an adjusted bundle and the drift of their tracks, against which the poses of further frames are
/// estimated.
class RefinedPoints {
 public:
  /// Takes the points that lie in front of the camera and agree with enough frames. `segment` is the one that the
  /// bundle was built from.
  RefinedPoints(const SegmentBundle& bundle, double drift_variance_ratio, const Segment& segment);

  /// In order of the bundle's points.
  const std::vector<Point>& points() const { return points_; }

  /// The pose of a frame of the run from its features, corrected by their tracks' drift.
  PoseEstimate EstimatePose(const std::vector<Frame>& frames, int frame,
                            const geometry::SE3& T_cam_world_initial) const;
  bool Accepts(const PoseEstimate& estimate, double min_inlier_ratio) const {
    return optimizer_.Accepts(estimate, min_inlier_ratio);
  }

 private:
  /// By frame of the run, in order, on the plane z = 1.
  using Drifts = std::vector<std::pair<int, Eigen::Vector2d>>;
  struct Piece {
    Eigen::Vector3d position;  // world
    Drifts drifts;
  };

  /// The drift in a frame: that in the nearest earlier frame of the bundle.
  static Eigen::Vector2d Drift(const Piece& piece, int frame);

  std::vector<Point> points_;
  std::unordered_map<std::int64_t, std::vector<Piece>> pieces_;  // of every track, in order of time
  PoseOptimizer optimizer_{PoseOptions()};
};

}  // namespace evo::odometry
