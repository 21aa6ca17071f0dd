#pragma once

#include <filesystem>
#include <stop_token>
#include <string>

namespace evo::io {

/// SHA-256 of a file's bytes in lower-case hexadecimal, as sha256sum prints it; streamed, about 1.5 GB/s where the
/// processor has SHA instructions. Throws Error (kInput) if the file cannot be read. Asked to
/// stop, it returns an empty string.
std::string Sha256(const std::filesystem::path& path, const std::stop_token& stop = {});

}  // namespace evo::io
