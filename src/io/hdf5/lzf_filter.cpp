#include "io/hdf5/lzf_filter.hpp"

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace evo::io::hdf5 {

namespace {

constexpr H5Z_filter_t kLzf = 32000;

/// An LZF stream is a row of commands. A first byte below 32 stands for that many literal bytes and one more. Otherwise
/// its upper three bits are a length (7: add the next byte) less two, and its lower five with the next byte a distance
/// less one: copy so many bytes from so far back in what is decoded already; the two may overlap.
/// False if the stream is damaged.
bool Decode(std::span<const std::uint8_t> stream, std::vector<std::uint8_t>* decoded) {
  std::size_t i = 0;
  while (i < stream.size()) {
    const std::size_t command = stream[i++];
    if (command < 32) {
      if (command + 1 > stream.size() - i) return false;
      decoded->insert(decoded->end(), stream.data() + i, stream.data() + i + command + 1);
      i += command + 1;
      continue;
    }
    std::size_t length = command >> 5;
    if (length == 7) {
      if (i == stream.size()) return false;
      length += stream[i++];
    }
    if (i == stream.size()) return false;
    const std::size_t distance = ((command & 31) << 8) + stream[i++] + 1;
    if (distance > decoded->size()) return false;
    for (length += 2; length > 0; --length) decoded->push_back((*decoded)[decoded->size() - distance]);
  }
  return true;
}

/// HDF5's side of it: `buffer` is replaced; 0 means failure. The third parameter is the size of a decoded chunk.
std::size_t Filter(unsigned flags, std::size_t parameter_count, const unsigned* parameters, std::size_t bytes,
                   std::size_t* buffer_bytes, void** buffer) {
  if (!(flags & H5Z_FLAG_REVERSE)) return 0;
  std::vector<std::uint8_t> decoded;
  const std::size_t expected = parameter_count > 2 ? parameters[2] : 1;
  decoded.reserve(expected);
  // HDF5 does not check that it is given a whole chunk.
  if (!Decode({static_cast<const std::uint8_t*>(*buffer), bytes}, &decoded) || decoded.size() < expected) return 0;
  void* const replacement = H5allocate_memory(decoded.size(), false);
  if (!replacement) return 0;
  std::memcpy(replacement, decoded.data(), decoded.size());
  H5free_memory(*buffer);
  *buffer = replacement;
  *buffer_bytes = decoded.size();
  return decoded.size();
}

}  // namespace

void RegisterLzf() {
  const H5Z_class2_t filter{H5Z_CLASS_T_VERS, kLzf, 0, 1, "lzf", nullptr, nullptr, Filter};
  H5Zregister(&filter);
}

}  // namespace evo::io::hdf5
