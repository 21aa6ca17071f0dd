#include "report/text_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "evo/core/error.hpp"

namespace evo::report {

std::string ReadTextFile(const std::filesystem::path& path) {
  const auto fail = [&] {
    throw Error(ErrorKind::kInput, path.string() + ": cannot be read: " + std::strerror(errno));
  };
  if (std::filesystem::is_directory(path)) throw Error(ErrorKind::kInput, path.string() + ": is a folder, not a file");
  std::ifstream file(path, std::ios::binary);
  if (!file) fail();
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) fail();
  return text;
}

}  // namespace evo::report
