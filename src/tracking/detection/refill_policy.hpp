#pragma once

#include <cstddef>

#include "evo/tracking/tracker_options.hpp"

namespace evo::tracking {

/// Decides when to detect new features: as soon as too few are alive, but not in every frame; twice as often while
/// fewer than half are.
class RefillPolicy {
 public:
  explicit RefillPolicy(const TrackerOptions& options)
      : min_alive_(options.refill_below * options.features),
        half_(0.5 * options.features),
        pause_(options.frames_between_refills),
        frames_since_refill_(pause_) {}

  /// Must be called once a frame.
  bool IsDue(std::size_t alive) {
    ++frames_since_refill_;
    const int pause = static_cast<double>(alive) < half_ ? (pause_ + 1) / 2 : pause_;
    const bool due = frames_since_refill_ >= pause && static_cast<double>(alive) < min_alive_;
    if (due) frames_since_refill_ = 0;
    return due;
  }

 private:
  double min_alive_;
  double half_;
  int pause_;  // frames
  int frames_since_refill_;
};

}  // namespace evo::tracking
