#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "evo/core/error.hpp"

namespace evo::io {

/// Random access to the bytes of a regular file. Every failure is an Error of kind kInput.
class ByteSource {
 public:
  explicit ByteSource(const std::filesystem::path& path);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::int64_t size() const { return size_; }
  /// Reads `count` bytes from `offset` on, fewer only at the end of the file; returns their number.
  std::size_t Read(std::int64_t offset, std::size_t count, char* buffer) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::int64_t size_ = 0;
};

}  // namespace evo::io
