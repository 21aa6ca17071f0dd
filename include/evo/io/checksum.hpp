#pragma once

#include <filesystem>
#include <stop_token>
#include <string>

namespace evo::io {

/// SHA-256 of a file in lower-case hexadecimal, as sha256sum prints it, at about 1.5 GB/s with SHA instructions.
/// Returns an empty text if `stop` is requested. Throws Error (kInput).
std::string Sha256(const std::filesystem::path& path, const std::stop_token& stop = {});

}  // namespace evo::io
