#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evo::events {

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

}  // namespace evo::events
