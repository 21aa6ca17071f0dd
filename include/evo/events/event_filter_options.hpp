#pragma once

#include "evo/core/parameters.hpp"
#include "evo/events/auto_mask.hpp"
#include "evo/events/flicker.hpp"
#include "evo/events/hot_pixels.hpp"

namespace evo::events {

/// The filters between the recording and all that reads its events.
struct EventFilterOptions {
  HotPixelOptions hot_pixels;
  FlickerOptions flicker;
  AutoMaskOptions auto_mask;
};

/// Adds `events.*`.
void Register(Parameters& parameters, EventFilterOptions& options);

}  // namespace evo::events
