#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "evo/events/hot_pixels.hpp"

namespace evo::io {

/// Reads a mask: a PNG (grey, colour or palette, with or without transparency) of the sensor's size, in which black or
/// transparent pixels are ignored. The result has height x width entries, row-major, 1 where events are ignored.
/// Throws Error (kInput) for a missing or damaged file, another size, and a mask that leaves no pixel.
std::vector<std::uint8_t> ReadMask(const std::filesystem::path& path, int width, int height);

/// Reads rows `x y`, further columns are not read; the result has y * width + x of each pixel. Throws Error (kInput)
/// with file and line.
std::vector<std::uint32_t> ReadHotPixels(const std::filesystem::path& path, int width, int height);

/// Writes rows `x y rate_hz`, sorted by row, then column. Throws Error (kOutput).
void WriteHotPixels(const std::filesystem::path& path, std::span<const events::HotPixel> pixels);

}  // namespace evo::io
