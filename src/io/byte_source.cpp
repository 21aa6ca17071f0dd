#include "io/byte_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace evo::io {

namespace {

Error ReadFailure(const std::filesystem::path& path, int code) {
  return {ErrorKind::kInput, path.string() + ": cannot be read: " + std::strerror(code)};
}

}  // namespace

ByteSource::ByteSource(const std::filesystem::path& path) : path_(path) {
  // Without O_NONBLOCK, opening a pipe that nobody writes to would hang.
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) throw ReadFailure(path, errno);
  struct stat status {};
  const int failure = ::fstat(descriptor_, &status) == 0 ? 0 : errno;
  if (failure || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    if (failure) throw ReadFailure(path, failure);
    throw Error(ErrorKind::kInput, path.string() + ": not a regular file; save the data to a file first");
  }
  size_ = status.st_size;
}

ByteSource::~ByteSource() { ::close(descriptor_); }

std::size_t ByteSource::Read(std::int64_t offset, std::size_t count, char* buffer) const {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::pread(descriptor_, buffer + done, count - done, offset + static_cast<std::int64_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw ReadFailure(path_, errno);
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

}  // namespace evo::io
