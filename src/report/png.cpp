#include "evo/report/png.hpp"

#include <png.h>

#include "evo/core/error.hpp"
#include "evo/core/output_file.hpp"

namespace evo {

void WritePng(const std::filesystem::path& path, const Canvas& canvas) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(canvas.width);
  image.height = static_cast<png_uint_32>(canvas.height);
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;  // for event frames a quarter larger, in a fraction of the time
  PendingPath pending(path);
  if (!png_image_write_to_file(&image, pending.temporary().c_str(), 0, canvas.rgb.data(), 0, nullptr)) {
    throw Error(ErrorKind::kOutput,
                path.string() + ": cannot write the image: " + image.message + "; is the disk full?");
  }
  pending.Commit();
}

}  // namespace evo
