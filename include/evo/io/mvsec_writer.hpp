#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "evo/events/depth_map.hpp"
#include "evo/events/event_columns.hpp"
#include "evo/events/grey_image.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::io {

/// Writes an MVSEC _data.hdf5: `davis/left/events` (N x 4 float64: x y t p, t in seconds, p = +-1), byte-shuffled and
/// deflated, and optional images `davis/left/image_raw` (N x height x width uint8, deflated) with `image_raw_ts` (s)
/// and `image_raw_event_inds` (int64, the first event at that time or after it). The file appears whole on Commit() or
/// not at all. Throws Error (kOutput).
class MvsecDataWriter {
 public:
  explicit MvsecDataWriter(const std::filesystem::path& path);
  ~MvsecDataWriter();

  /// Appends events in order of time.
  void Append(const events::EventColumns& events);
  /// Appends an image in order of time; all have one size. `events_before` events of the file have earlier stamps.
  void AppendImage(TimeNs t, const events::GreyImage& image, std::size_t events_before);
  void Commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes a file of events alone.
void WriteMvsecEvents(const std::filesystem::path& path, const events::EventColumns& events);

/// Writes an MVSEC _gt.hdf5: `davis/left/odometry` (LOAM) and `davis/left/pose` (Cartographer), N x 4 x 4 row-major
/// T_world_cam. Optional are the depth (m) of the raw image, `davis/left/depth_image_raw`, and of the rectified one,
/// `davis/left/depth_image_rect` (N x height x width), and the flow (px) of the rectified image, which MVSEC calls
/// `davis/left/flow_dist` (N x 2 x height x width): float32, deflated. Each has its stamps (s) in `..._ts`. The file
/// appears whole on Commit() or not at all. Throws Error (kOutput).
class MvsecGroundTruthWriter {
 public:
  MvsecGroundTruthWriter(const std::filesystem::path& path, const geometry::Trajectory& odometry,
                         const geometry::Trajectory& pose);
  ~MvsecGroundTruthWriter();

  /// Appends a map in order of time; all maps have one size. Moving pixels go into `davis/left/moving_image_raw`,
  /// uint8; all maps mark them or none.
  void AppendDepth(TimeNs t, const events::DepthMap& map);
  void AppendRectifiedDepth(TimeNs t, const events::DepthMap& map);
  /// Appends the flow from time `t` to the next map.
  void AppendFlow(TimeNs t, const events::FlowMap& map);
  void Commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes a file of poses alone.
void WriteMvsecGroundTruth(const std::filesystem::path& path, const geometry::Trajectory& odometry,
                           const geometry::Trajectory& pose);

}  // namespace evo::io
