#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "evo/events/depth_map.hpp"
#include "evo/events/event_columns.hpp"
#include "evo/events/grey_image.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::io {

/// Writes an MVSEC _data.hdf5: `davis/left/events` (N x 4 float64: x y t p, t in seconds, p = +-1) block by block, in
/// chunks that are byte-shuffled and deflated, and, if there are any, the images `davis/left/image_raw` (N x height x
/// width uint8, deflated) with `image_raw_ts` (s) and `image_raw_event_inds` (int64, the first event at that time or
/// after it). The file appears whole on Commit() or not at all. Throws Error (kOutput).
class MvsecDataWriter {
 public:
  explicit MvsecDataWriter(const std::filesystem::path& path);
  ~MvsecDataWriter();

  /// Events in order of time, after those appended before.
  void Append(const events::EventColumns& events);
  /// All images in order of time and of one size; `events_before` of all events have earlier stamps.
  void AppendImage(TimeNs t, const events::GreyImage& image, std::size_t events_before);
  void Commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// All of `events` in one call.
void WriteMvsecEvents(const std::filesystem::path& path, const events::EventColumns& events);

/// Writes an MVSEC _gt.hdf5: `davis/left/odometry` (LOAM's place) and `davis/left/pose` (Cartographer's), N x 4 x 4
/// row-major T_world_cam with their stamps in seconds, and, if there are any, depth maps of the raw image,
/// `davis/left/depth_image_raw`, and of the rectified one, `davis/left/depth_image_rect` (N x height x width), and the
/// flow in the rectified image, which MVSEC calls `davis/left/flow_dist` (N x 2 x height x width): float32, deflated,
/// each with its stamps in `..._ts`. The file appears whole on Commit() or not at all. Throws Error (kOutput).
class MvsecGroundTruthWriter {
 public:
  MvsecGroundTruthWriter(const std::filesystem::path& path, const geometry::Trajectory& odometry,
                         const geometry::Trajectory& pose);
  ~MvsecGroundTruthWriter();

  /// All maps of one kind in order of time and of one size. What moves goes into `davis/left/moving_image_raw`, uint8;
  /// either all maps tell it or none.
  void AppendDepth(TimeNs t, const events::DepthMap& map);
  void AppendRectifiedDepth(TimeNs t, const events::DepthMap& map);
  /// Stamped with the time from which on things move so far.
  void AppendFlow(TimeNs t, const events::FlowMap& map);
  void Commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Poses alone, in one call.
void WriteMvsecGroundTruth(const std::filesystem::path& path, const geometry::Trajectory& odometry,
                           const geometry::Trajectory& pose);

}  // namespace evo::io
