#pragma once

#include <filesystem>

#include "evo/events/grey_image.hpp"
#include "evo/report/draw.hpp"

namespace evo::report {

/// Writes `canvas` as an 8-bit RGB PNG, whole or not at all; the same image gives the same bytes.
/// Throws Error (kOutput).
void WritePng(const std::filesystem::path& path, const Canvas& canvas);
/// The same for an 8-bit grey PNG.
void WritePng(const std::filesystem::path& path, const events::GreyImage& image);

}  // namespace evo::report
