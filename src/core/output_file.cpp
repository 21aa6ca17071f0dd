#include "evo/core/output_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "evo/core/error.hpp"

namespace evo {

PendingPath::PendingPath(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code failure;
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), failure);
  if (failure) {
    throw Error(ErrorKind::kOutput, path_.parent_path().string() + ": cannot create the folder: " + failure.message());
  }
  temporary_ = path_;
  temporary_ += ".part" + std::to_string(::getpid());
}

PendingPath::~PendingPath() {
  if (committed_) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void PendingPath::Commit() {
  std::error_code failure;
  std::filesystem::rename(temporary_, path_, failure);
  if (failure) throw Error(ErrorKind::kOutput, path_.string() + ": cannot move into place: " + failure.message());
  committed_ = true;
}

OutputFile::OutputFile(std::filesystem::path path) : pending_(std::move(path)) {
  stream_.open(pending_.temporary(), std::ios::binary | std::ios::trunc);
  if (!stream_) {
    throw Error(ErrorKind::kOutput,
                pending_.path().string() + ": cannot write: " + std::strerror(errno) + "; choose another --out folder");
  }
}

void OutputFile::Check() const {
  if (!stream_) {
    throw Error(ErrorKind::kOutput, pending_.path().string() + ": writing failed: " +
                                        std::strerror(errno ? errno : EIO) + "; is the disk full?");
  }
}

void OutputFile::Commit() {
  errno = 0;
  stream_.close();
  Check();
  pending_.Commit();
}

void WriteText(const std::filesystem::path& path, const std::string& text) {
  OutputFile file(path);
  file.stream() << text;
  file.Commit();
}

}  // namespace evo
