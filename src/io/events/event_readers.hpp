#pragma once

#include <filesystem>
#include <memory>

#include "evo/events/event_reader.hpp"

namespace evo::io {

/// The reader of each format, for OpenEvents, which documents the arguments. Add a format's function here.
std::unique_ptr<events::EventReader> OpenMvsecEvents(const std::filesystem::path& path,
                                                     const events::Interval& interval, int width, int height);
std::unique_ptr<events::EventReader> OpenTextEvents(const std::filesystem::path& path, const events::Interval& interval,
                                                    int width, int height);

/// The stamp `offset` after `first`, or the largest one where the sum overflows.
TimeNs SaturatedSum(TimeNs first, TimeNs offset);

}  // namespace evo::io
