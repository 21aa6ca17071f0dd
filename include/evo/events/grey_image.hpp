#pragma once

#include <cstdint>
#include <vector>

namespace evo::events {

/// An 8-bit image. Integer coordinates are pixel centres.
struct GreyImage {
  int width = 0;                   ///< px
  int height = 0;                  ///< px
  std::vector<std::uint8_t> grey;  ///< height x width, row-major from the top left
};

}  // namespace evo::events
