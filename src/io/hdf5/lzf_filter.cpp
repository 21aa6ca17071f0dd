#include "io/hdf5/lzf_filter.hpp"

#include <hdf5.h>
#include <lzf.h>

#include <cstddef>

namespace evo::io::hdf5 {

namespace {

constexpr H5Z_filter_t kLzfFilter = 32000;      // its number in the HDF Group's registry
constexpr std::size_t kMaxExpansion = 264 / 3;  // LZF's longest reference takes 3 bytes and stands for 264

/// Decodes a chunk in `buffer`, which it replaces; returns the decoded bytes, 0 on failure. h5py stores the size of a
/// decoded chunk as the third parameter.
std::size_t Decode(unsigned flags, std::size_t parameter_count, const unsigned* parameters, std::size_t bytes,
                   std::size_t* buffer_bytes, void** buffer) {
  // lzf_decompress reads the first byte of an empty stream.
  if (!(flags & H5Z_FLAG_REVERSE) || bytes == 0) return 0;
  const std::size_t largest = kMaxExpansion * bytes;
  const bool size_known = parameter_count > 2;
  const std::size_t capacity = size_known ? parameters[2] : largest;
  if (capacity > largest) return 0;  // a damaged size, perhaps of gigabytes
  void* const decoded = H5allocate_memory(capacity, false);
  if (!decoded) return 0;
  const std::size_t size =
      lzf_decompress(*buffer, static_cast<unsigned>(bytes), decoded, static_cast<unsigned>(capacity));
  // HDF5 does not check that it gets a whole chunk.
  if (size == 0 || (size_known && size != capacity)) {
    H5free_memory(decoded);
    return 0;
  }
  H5free_memory(*buffer);
  *buffer = decoded;
  *buffer_bytes = capacity;
  return size;
}

}  // namespace

void RegisterLzf() {
  const H5Z_class2_t filter{H5Z_CLASS_T_VERS, kLzfFilter, 0, 1, "lzf", nullptr, nullptr, Decode};
  H5Zregister(&filter);
}

}  // namespace evo::io::hdf5
