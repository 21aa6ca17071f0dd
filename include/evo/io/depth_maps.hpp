#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "evo/core/time.hpp"

namespace evo {

/// For each pixel the z coordinate, in m, of what the camera sees there; NaN or 0 where that is not known.
struct DepthMap {
  int width = 0;              ///< px
  int height = 0;             ///< px
  std::vector<double> depth;  ///< height x width, row-major
  /// The same: 1 where what the camera sees moves by itself, 0 where it rests; empty if that is not known.
  std::vector<std::uint8_t> moving = {};

  double At(int x, int y) const { return depth[IndexOf(x, y)]; }
  bool IsMoving(int x, int y) const { return !moving.empty() && moving[IndexOf(x, y)] != 0; }

 private:
  std::size_t IndexOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// For each pixel how far, in px, what it shows moves until a later time; NaN where that is not known.
struct FlowMap {
  int width = 0;             ///< px
  int height = 0;            ///< px
  std::vector<double> flow;  ///< 2 x height x width, row-major: to the right, then down
};

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
  DepthMap Read(std::size_t index) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace evo
