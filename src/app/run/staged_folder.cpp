#include "app/run/staged_folder.hpp"

#include <unistd.h>

#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "evo/core/error.hpp"

namespace evo::app {

namespace fs = std::filesystem;

namespace {

void Require(const std::error_code& failure, const fs::path& path, const std::string& what) {
  if (failure) throw Error(ErrorKind::kOutput, path.string() + ": " + what + ": " + failure.message());
}

}  // namespace

StagedFolder::StagedFolder(fs::path out)
    : out_(std::move(out)), path_(out_ / ("unfinished.part" + std::to_string(::getpid()))) {
  std::error_code failure;
  made_out_ = fs::create_directories(out_, failure);
  if (!failure) fs::create_directory(path_, failure);
  Require(failure, path_, "cannot create the folder");
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  if (made_out_) fs::remove(out_, ignored);  // only if it is empty
}

void StagedFolder::Commit() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(path_)) {
    if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), path_));
  }
  for (const auto& file : files) {
    std::error_code failure;
    const fs::path place = out_ / file;
    fs::create_directories(place.parent_path(), failure);
    if (!failure) fs::rename(path_ / file, place, failure);
    Require(failure, place, "cannot move into place");
  }
}

}  // namespace evo::app
