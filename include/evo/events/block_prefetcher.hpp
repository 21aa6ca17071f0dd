#pragma once

#include <future>

#include "evo/events/event_columns.hpp"
#include "evo/events/event_reader.hpp"

namespace evo::events {

/// Reads a block of events in a thread of its own while the caller processes the one before it.
class BlockPrefetcher {
 public:
  /// Reads nothing before the first call of Next().
  explicit BlockPrefetcher(EventReader* reader) : reader_(reader) {}

  /// Replaces `block` by the next one. False at the end of the stream.
  bool Next(EventColumns* block);
  /// The reader's progress at the block that Next() returned last.
  double progress() const { return progress_; }
  /// Waits until the reader is idle, after which it may be asked.
  void Wait() const;

 private:
  void ReadAhead();

  EventReader* reader_;
  EventColumns next_;
  double progress_ = 0.0;
  std::future<bool> has_next_;  // declared last: its destructor waits for the thread that writes the block
};

}  // namespace evo::events
