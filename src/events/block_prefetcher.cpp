#include "evo/events/block_prefetcher.hpp"

#include <utility>

namespace evo::events {

bool BlockPrefetcher::Next(EventColumns* block) {
  if (!has_next_.valid()) ReadAhead();
  const bool has_next = has_next_.get();
  progress_ = reader_->progress();  // no thread reads now
  if (!has_next) return false;
  std::swap(*block, next_);
  ReadAhead();
  return true;
}

void BlockPrefetcher::Wait() const {
  if (has_next_.valid()) has_next_.wait();
}

void BlockPrefetcher::ReadAhead() {
  has_next_ = std::async(std::launch::async, [this] { return reader_->Next(&next_); });
}

}  // namespace evo::events
