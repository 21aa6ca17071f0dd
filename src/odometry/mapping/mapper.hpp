#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "evo/odometry/odometry_options.hpp"
#include "evo/odometry/point.hpp"
#include "odometry/frontend/frame.hpp"
#include "odometry/mapping/depth_filter.hpp"
#include "odometry/mapping/map.hpp"

namespace evo::odometry {

/// A tracked frame on its way from the pose thread to the depth thread.
struct FrameMessage {
  int index = 0;       ///< of the frame
  Frame frame;         ///< its own pose is not used
  int reference = -1;  ///< key frame that the pose is relative to; -1: the pose is in the world
  geometry::SE3 T_cam_reference;
  bool key_frame = false;    ///< becomes the next key frame, numbered from 0 without gaps
  bool new_segment = false;  ///< the map starts anew with `points`
  std::vector<Point> points;
  std::vector<std::int64_t> inliers;   ///< tracks whose point agreed with the frame
  std::vector<std::int64_t> outliers;  ///< tracks whose point contradicted it
};

/// What a frame has changed in the map, on its way back.
struct MapUpdate {
  int index = 0;                                                 ///< of the frame
  std::vector<std::pair<std::int64_t, Eigen::Vector3d>> points;  ///< new or moved, world
  std::vector<std::int64_t> removed;                             ///< tracks
  std::vector<std::pair<int, geometry::SE3>> key_frames;         ///< new or moved: number, T_cam_world
};

/// The depth thread's work: owns the map, measures depths, adds converged points, drops points that frames contradict,
/// refines the last key frames together with their points.
class Mapper {
 public:
  /// `px_angle` rad is the angle of one pixel.
  Mapper(const MapperOptions& options, double px_angle);

  MapUpdate Process(const FrameMessage& message);

  const Map& map() const { return map_; }
  /// Points of the segments before the present one.
  const std::vector<Point>& finished() const { return finished_; }

 private:
  void StartSegment(const FrameMessage& message, MapUpdate* update);
  void Judge(const FrameMessage& message, MapUpdate* update);
  void MeasureDepths(const Frame& frame);
  void AddConverged(MapUpdate* update);
  void AddKeyFrame(const Frame& frame, MapUpdate* update);
  void SowSeeds(const Frame& frame);
  void RefineWindow(MapUpdate* update);
  SceneDepth DepthOfScene(const Frame& frame) const;

  MapperOptions options_;
  Map map_;
  DepthFilter filter_;
  std::vector<Point> finished_;
  std::vector<Seed> converged_;
  Frame measured_;         // the last frame that the depth filter has used
  int segment_begin_ = 0;  // its first key frame
};

}  // namespace evo::odometry
