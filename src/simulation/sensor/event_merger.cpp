#include "simulation/sensor/event_merger.hpp"

#include <algorithm>

namespace evo::simulation {

void EventMerger::Add(const events::EventColumns& events) {
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events.t[i] < 0) continue;
    pending_.push_back({events.t[i], events.y[i], events.x[i], events.polarity[i]});
  }
}

const events::EventColumns& EventMerger::TakeBefore(TimeNs end) {
  std::ranges::sort(pending_);
  const auto later = std::ranges::lower_bound(pending_, end, {}, &Event::t);
  batch_.clear();
  for (auto event = pending_.begin(); event != later; ++event) {
    batch_.push_back(event->t, event->x, event->y, event->polarity);
  }
  pending_.erase(pending_.begin(), later);
  return batch_;
}

}  // namespace evo::simulation
