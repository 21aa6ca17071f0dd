#include "app/output_folder.hpp"

#include <unistd.h>

#include <system_error>

#include "evo/core/error.hpp"

namespace evo::app {

void PrepareOutputFolder(const std::filesystem::path& folder, const std::vector<std::string>& results, bool force) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) {
    throw Error(ErrorKind::kOutput,
                folder.string() + ": cannot create the folder: " + failure.message() + "; choose another --out folder");
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Error(ErrorKind::kOutput, folder.string() + ": the folder cannot be written to; choose another --out folder");
  }
  if (force) return;
  for (const auto& result : results) {
    if (std::filesystem::exists(folder / result)) {
      throw Error(ErrorKind::kOutput, folder.string() + ": already holds results (" + result +
                                          "); choose another --out folder or add --force to overwrite them");
    }
  }
}

}  // namespace evo::app
