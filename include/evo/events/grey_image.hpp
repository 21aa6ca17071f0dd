#pragma once

#include <cstdint>
#include <vector>

namespace evo::events {

/// An 8-bit image, row by row from the top left; integer coordinates are pixel centres.
struct GreyImage {
  int width = 0;                   ///< px
  int height = 0;                  ///< px
  std::vector<std::uint8_t> grey;  ///< width * height
};

}  // namespace evo::events
