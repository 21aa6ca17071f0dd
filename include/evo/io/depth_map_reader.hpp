#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/depth_map.hpp"

namespace evo::io {

/// Whether the file is an MVSEC _gt.hdf5 with depth maps of the raw left image.
bool HasDepthMaps(const std::filesystem::path& path);

/// Reads the depth maps of the left camera's raw (distorted) image from an MVSEC _gt.hdf5, one at a time:
/// `davis/left/depth_image_raw`, N x height x width in m, and `davis/left/depth_image_raw_ts`, N stamps in s. The
/// optional `davis/left/moving_image_raw` of the same shape, written by `evo-run simulate`, marks moving pixels with 1.
/// All functions throw Error (kInput) with data set and row.
class DepthMapReader {
 public:
  explicit DepthMapReader(const std::filesystem::path& path);
  ~DepthMapReader();

  /// One or more, strictly increasing.
  const std::vector<TimeNs>& stamps() const;
  int width() const;
  int height() const;
  /// Reads map number `index`, from 0. Negative depths are refused.
  events::DepthMap Read(std::size_t index) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace evo::io
