#pragma once

#include <cstddef>
#include <cstdint>

namespace evo::events {

/// The square tiles of a sensor, numbered row by row. The last ones may reach beyond the sensor.
struct FlickerTiles {
  static constexpr int kShift = 4;
  static constexpr int kSide = 1 << kShift;  ///< px
  static constexpr std::size_t kPixels = std::size_t{kSide} * kSide;

  FlickerTiles(int width, int height)
      : columns((static_cast<std::size_t>(width) + kSide - 1) / kSide),
        rows((static_cast<std::size_t>(height) + kSide - 1) / kSide) {}
  std::size_t size() const { return columns * rows; }
  std::size_t TileOf(std::uint16_t x, std::uint16_t y) const {
    return static_cast<std::size_t>(y >> kShift) * columns + (x >> kShift);
  }
  /// Index of a pixel within its tile.
  static std::size_t PixelOf(std::uint16_t x, std::uint16_t y) {
    return static_cast<std::size_t>(y & (kSide - 1)) << kShift | (x & (kSide - 1));
  }
  struct Pixel {
    std::uint16_t x, y;
  };
  /// The pixel with index `p` among those of all tiles, tile by tile.
  Pixel PixelAt(std::size_t p) const {
    const std::size_t tile = p / kPixels;
    return {static_cast<std::uint16_t>(tile % columns * kSide + p % kSide),
            static_cast<std::uint16_t>(tile / columns * kSide + p % kPixels / kSide)};
  }
  /// Index of the sixteenth of the tile that holds a pixel.
  static std::size_t PartOf(std::uint16_t x, std::uint16_t y) {
    return static_cast<std::size_t>(y >> (kShift - 2) & 3) << 2 | (x >> (kShift - 2) & 3);
  }

  std::size_t columns;
  std::size_t rows;
};

}  // namespace evo::events
