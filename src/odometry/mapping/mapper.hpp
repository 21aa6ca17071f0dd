#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "evo/odometry/odometry_options.hpp"
#include "evo/odometry/point.hpp"
#include "odometry/frontend/frame.hpp"
#include "odometry/mapping/depth_filter.hpp"
#include "odometry/mapping/map.hpp"

namespace evo::odometry {

/// A pose relative to a key frame.
struct KeyFramePose {
  int key_frame = -1;  ///< number of the key frame; -1: the world
  geometry::SE3 T_cam_key;
};

/// A tracked frame on its way from the pose thread to the depth thread.
struct FrameMessage {
  int index = 0;                              ///< of the frame
  Frame frame;                                ///< without its pose
  KeyFramePose pose;                          ///< of the frame
  bool is_key_frame = false;                  ///< becomes the next key frame; these are numbered from 0 without gaps
  std::optional<std::vector<Point>> new_map;  ///< replaces all points at the beginning of a segment
  std::vector<std::int64_t> inliers;          ///< tracks whose points agree with the frame
  std::vector<std::int64_t> outliers;         ///< tracks whose points contradict the frame
};

/// The changes of the map by a frame, on their way back.
struct MapUpdate {
  int index = 0;                                                 ///< of the frame
  std::vector<std::pair<std::int64_t, Eigen::Vector3d>> points;  ///< new or moved: track, world position
  std::vector<std::int64_t> removed;                             ///< tracks
  std::vector<std::pair<int, geometry::SE3>> key_frames;         ///< new or moved: number, T_cam_world
};

/// The depth thread's work. It owns the map, updates the depth filter, inserts converged points, removes points that
/// frames contradict, and adjusts the last key frames with their points.
class Mapper {
 public:
  /// `pixel_angle` is the angle of one pixel, rad.
  Mapper(const MapperOptions& options, double pixel_angle);

  MapUpdate Process(const FrameMessage& message);

  const Map& map() const { return map_; }
  /// The points of the segments before the current one.
  const std::vector<Point>& finished_points() const { return finished_points_; }

 private:
  void StartSegment(const FrameMessage& message, MapUpdate* update);
  void UpdateCounts(const FrameMessage& message);
  void RemoveOutliers(const std::vector<std::int64_t>& tracks, MapUpdate* update);
  void UpdateDepths(const Frame& frame);
  void InsertConverged(MapUpdate* update);
  void AddKeyFrame(const Frame& frame, MapUpdate* update);
  /// Creates a seed for every feature without point and seed, and updates it with the key frames that observe it.
  void CreateSeeds(const Frame& frame);
  void RefineWindow(MapUpdate* update);
  SceneDepth DepthInFrame(const Frame& frame) const;

  MapperOptions options_;
  Map map_;
  DepthFilter filter_;
  std::vector<Point> finished_points_;
  std::vector<Seed> converged_;
  Frame last_measured_;    // the last frame that has updated the depth filter
  int segment_begin_ = 0;  // number of the segment's first key frame
};

}  // namespace evo::odometry
