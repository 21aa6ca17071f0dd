#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evo::events {

/// The depth of each pixel: the z coordinate in the camera's frame, in m. NaN or 0 if unknown.
struct DepthMap {
  int width = 0;              ///< px
  int height = 0;             ///< px
  std::vector<double> depth;  ///< height x width, row-major
  /// 1 where the pixel shows a moving object, 0 where it shows the resting scene; height x width, empty if unknown.
  std::vector<std::uint8_t> moving = {};

  double At(int x, int y) const { return depth[IndexOf(x, y)]; }
  bool IsMoving(int x, int y) const { return !moving.empty() && moving[IndexOf(x, y)] != 0; }

 private:
  std::size_t IndexOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// The displacement of each pixel's point until a later instant, in px. NaN if unknown.
struct FlowMap {
  int width = 0;             ///< px
  int height = 0;            ///< px
  std::vector<double> flow;  ///< 2 x height x width, row-major: the x components, then the y components
};

}  // namespace evo::events
