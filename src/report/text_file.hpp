#pragma once

#include <filesystem>
#include <string>

namespace evo {

/// The bytes of a file. Throws Error (kInput).
std::string ReadTextFile(const std::filesystem::path& path);

}  // namespace evo
