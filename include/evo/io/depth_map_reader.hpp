#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/depth_map.hpp"

namespace evo::io {

/// Whether an MVSEC _gt.hdf5 holds depth maps of the raw left image. False for a file of another kind.
bool HasDepthMaps(const std::filesystem::path& path);

/// The depth maps of the left camera's raw (distorted) image in an MVSEC _gt.hdf5: `davis/left/depth_image_raw`,
/// N x height x width, and `davis/left/depth_image_raw_ts`, N stamps in s. Where there is a
/// `davis/left/moving_image_raw` of the same shape (ours, not MVSEC's), it tells by 0 and 1 what moves. Maps are read
/// one at a time. All functions throw Error (kInput) with data set and row.
class DepthMapReader {
 public:
  explicit DepthMapReader(const std::filesystem::path& path);
  ~DepthMapReader();

  /// In strictly increasing order, one or more.
  const std::vector<TimeNs>& stamps() const;
  int width() const;
  int height() const;
  /// Map number `index`. Negative depths are refused.
  events::DepthMap Read(std::size_t index) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace evo::io
