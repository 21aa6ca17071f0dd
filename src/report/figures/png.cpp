#include "evo/report/png.hpp"

#include <png.h>

#include "evo/core/error.hpp"
#include "evo/core/output_file.hpp"

namespace evo::report {

namespace {

void Write(const std::filesystem::path& path, int width, int height, png_uint_32 format, const std::uint8_t* pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = format;
  image.flags = PNG_IMAGE_FLAG_FAST;  // event frames get a quarter larger in a fraction of the time
  PendingPath pending(path);
  if (!png_image_write_to_file(&image, pending.temporary().c_str(), 0, pixels, 0, nullptr)) {
    throw Error(ErrorKind::kOutput,
                path.string() + ": cannot write the image: " + image.message + "; is the disk full?");
  }
  pending.Commit();
}

}  // namespace

void WritePng(const std::filesystem::path& path, const Canvas& canvas) {
  Write(path, canvas.width, canvas.height, PNG_FORMAT_RGB, canvas.rgb.data());
}

void WritePng(const std::filesystem::path& path, const events::GreyImage& image) {
  Write(path, image.width, image.height, PNG_FORMAT_GRAY, image.grey.data());
}

}  // namespace evo::report
