#include "evo/core/output_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "evo/core/error.hpp"

namespace evo {

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code failure;
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), failure);
  if (failure) {
    throw Error(ErrorKind::kOutput, path_.parent_path().string() + ": cannot create the folder: " + failure.message());
  }
  temporary_ = path_;
  temporary_ += ".part" + std::to_string(::getpid());
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_) {
    throw Error(ErrorKind::kOutput,
                path_.string() + ": cannot write: " + std::strerror(errno) + "; choose another --out folder");
  }
}

OutputFile::~OutputFile() {
  if (committed_) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void OutputFile::Commit() {
  errno = 0;
  stream_.close();
  if (!stream_) {
    throw Error(ErrorKind::kOutput,
                path_.string() + ": writing failed: " + std::strerror(errno ? errno : EIO) + "; is the disk full?");
  }
  std::error_code failure;
  std::filesystem::rename(temporary_, path_, failure);
  if (failure) throw Error(ErrorKind::kOutput, path_.string() + ": cannot move into place: " + failure.message());
  committed_ = true;
}

}  // namespace evo
