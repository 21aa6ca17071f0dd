#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "evo/events/hot_pixels.hpp"

namespace evo::io {

/// Pixels whose events are ignored.
struct Mask {
  int width = 0;                      ///< px
  int height = 0;                     ///< px
  std::vector<std::uint8_t> ignored;  ///< height x width, row-major; 1 where events are ignored
};

/// Reads a mask of any size: a PNG (grey, colour or palette, with or without transparency) in which black or
/// transparent pixels are ignored. Throws Error (kInput) for a missing or damaged file and a mask that leaves no pixel.
Mask ReadMask(const std::filesystem::path& path);

/// Reads the `ignored` of a mask of the sensor's size. Throws Error (kInput), also for another size.
std::vector<std::uint8_t> ReadMask(const std::filesystem::path& path, int width, int height);

/// Reads rows `x y`, further columns are not read; the result has y * width + x of each pixel. Throws Error (kInput)
/// with file and line.
std::vector<std::uint32_t> ReadHotPixels(const std::filesystem::path& path, int width, int height);

/// Writes rows `x y rate_hz`, sorted by row, then column. Throws Error (kOutput).
void WriteHotPixels(const std::filesystem::path& path, std::span<const events::HotPixel> pixels);

}  // namespace evo::io
