#include "evo/io/pixel_files.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <tuple>
#include <utility>

#include "evo/core/error.hpp"
#include "evo/core/output_file.hpp"
#include "evo/io/file_kind.hpp"
#include "io/text_lines.hpp"

namespace evo::io {

namespace {

/// A PNG file that is being read.
class PngFile {
 public:
  explicit PngFile(const std::filesystem::path& path) : path_(path.string()) {
    image_.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&image_, path_.c_str())) throw Failure();
  }
  ~PngFile() { png_image_free(&image_); }
  PngFile(const PngFile&) = delete;
  PngFile& operator=(const PngFile&) = delete;

  std::size_t width() const { return image_.width; }
  std::size_t height() const { return image_.height; }

  /// Four bytes a pixel: red, green, blue, opacity.
  std::vector<std::uint8_t> ReadRgba() {
    image_.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(image_));
    if (!png_image_finish_read(&image_, nullptr, rgba.data(), 0, nullptr)) throw Failure();
    return rgba;
  }

 private:
  Error Failure() const {
    return {ErrorKind::kInput, path_ + ": cannot be read as PNG: " + image_.message + "; give a whole PNG image"};
  }

  std::string path_;
  png_image image_{};
};

std::uint32_t ParseColumnOrRow(const TextLines& lines, std::string_view text, const char* name, int size) {
  const auto value = ParseInteger(text);
  if (value && *value >= 0 && *value < size) return static_cast<std::uint32_t>(*value);
  throw lines.Failure(fmt::format("the {} {} is not a whole number from 0 to {}", name, Quote(text), size - 1));
}

}  // namespace

Mask ReadMask(const std::filesystem::path& path) {
  RequireKind(path, {FileKind::kPng}, "a mask, a PNG image in which black pixels are ignored");
  PngFile file(path);
  Mask mask{static_cast<int>(file.width()), static_cast<int>(file.height()), {}};
  const auto rgba = file.ReadRgba();
  mask.ignored.resize(rgba.size() / 4);
  for (std::size_t i = 0; i < mask.ignored.size(); ++i) {
    const std::uint8_t* const pixel = &rgba[4 * i];
    mask.ignored[i] = pixel[3] == 0 || (pixel[0] | pixel[1] | pixel[2]) == 0 ? 1 : 0;
  }
  if (std::ranges::all_of(mask.ignored, [](auto is_ignored) { return is_ignored != 0; })) {
    throw Error(ErrorKind::kInput,
                path.string() + ": the mask is black everywhere and leaves no event; black is what is ignored");
  }
  return mask;
}

std::vector<std::uint8_t> ReadMask(const std::filesystem::path& path, int width, int height) {
  Mask mask = ReadMask(path);
  if (mask.width != width || mask.height != height) {
    throw Error(ErrorKind::kInput,
                fmt::format("{}: the mask has {} x {} px, the sensor {} x {}; draw the mask in the sensor's raw pixels",
                            path.string(), mask.width, mask.height, width, height));
  }
  return std::move(mask.ignored);
}

std::vector<std::uint32_t> ReadHotPixels(const std::filesystem::path& path, int width, int height) {
  std::vector<std::uint32_t> pixels;
  TextLines lines(path);
  for (std::string_view line; lines.Next(&line);) {
    const auto fields = SplitFields(line);
    if (fields.size() < 2) throw lines.Failure("expected 'x y', found " + Quote(line));
    const std::uint32_t x = ParseColumnOrRow(lines, fields[0], "column", width);
    const std::uint32_t y = ParseColumnOrRow(lines, fields[1], "row", height);
    pixels.push_back(y * static_cast<std::uint32_t>(width) + x);
  }
  return pixels;
}

void WriteHotPixels(const std::filesystem::path& path, std::span<const events::HotPixel> pixels) {
  std::vector<events::HotPixel> sorted(pixels.begin(), pixels.end());
  std::ranges::sort(sorted, {}, [](const auto& pixel) { return std::tuple(pixel.y, pixel.x); });
  std::string text = "# x y rate_hz\n";
  for (const auto& pixel : sorted) text += fmt::format("{} {} {:.1f}\n", pixel.x, pixel.y, pixel.Rate());
  WriteText(path, text);
}

}  // namespace evo::io
