#pragma once

#include <filesystem>

#include "evo/core/output_file.hpp"
#include "evo/events/event_columns.hpp"

namespace evo::io {

/// Writes a UZH events.txt, lines `t x y p`: seconds with six decimals (stamps must be whole microseconds, at 0 or
/// later), p 1 or 0. The file appears whole on Commit() or not at all. Throws Error (kOutput).
class UzhEventWriter {
 public:
  explicit UzhEventWriter(const std::filesystem::path& path) : file_(path) {}

  /// Appends events in order of time.
  void Append(const events::EventColumns& events);
  void Commit() { file_.Commit(); }

 private:
  OutputFile file_;
};

}  // namespace evo::io
