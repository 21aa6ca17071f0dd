#pragma once

#include <filesystem>
#include <string>

namespace evo::report {

/// Reads a whole file. Throws Error (kInput).
std::string ReadTextFile(const std::filesystem::path& path);

}  // namespace evo::report
