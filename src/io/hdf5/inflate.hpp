#pragma once

#include <cstdint>
#include <span>

namespace evo::io {

/// Decodes a zlib stream that holds just as many bytes as `inflated`, checksum included; false if it does not. With
/// libdeflate where that is installed, which takes a third of the time that zlib takes, to the same bytes.
bool Inflate(std::span<const std::uint8_t> stored, std::span<std::uint8_t> inflated);

}  // namespace evo::io
