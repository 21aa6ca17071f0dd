#pragma once

#include <filesystem>
#include <string>

namespace evo::report {

/// The bytes of a file. Throws Error (kInput).
std::string ReadTextFile(const std::filesystem::path& path);

}  // namespace evo::report
