#include "io/hdf5/inflate.hpp"

#ifdef EVO_LIBDEFLATE
#include <libdeflate.h>

#include <memory>
#else
#include <zlib.h>
#endif

namespace evo::io {

#ifdef EVO_LIBDEFLATE

bool Inflate(std::span<const std::uint8_t> stored, std::span<std::uint8_t> inflated) {
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  // Without a place for the number of bytes, it must be the one expected.
  return decompressor && libdeflate_zlib_decompress(decompressor.get(), stored.data(), stored.size(), inflated.data(),
                                                    inflated.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

#else

bool Inflate(std::span<const std::uint8_t> stored, std::span<std::uint8_t> inflated) {
  uLongf bytes = inflated.size();
  return uncompress(inflated.data(), &bytes, stored.data(), stored.size()) == Z_OK && bytes == inflated.size();
}

#endif

}  // namespace evo::io
