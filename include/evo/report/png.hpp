#pragma once

#include <filesystem>

#include "evo/events/grey_image.hpp"
#include "evo/report/draw.hpp"

namespace evo::report {

/// Writes an 8-bit RGB PNG; equal images give equal bytes. Throws Error (kOutput) and leaves no incomplete file.
void WritePng(const std::filesystem::path& path, const Canvas& canvas);
/// Writes an 8-bit grey PNG.
void WritePng(const std::filesystem::path& path, const events::GreyImage& image);

}  // namespace evo::report
