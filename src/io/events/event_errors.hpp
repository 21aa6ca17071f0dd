#pragma once

#include <filesystem>
#include <string>

#include "evo/core/error.hpp"
#include "evo/events/event_reader.hpp"

namespace evo::io {

/// kNothingToDo: the recording from `first` to `last` has no event in the interval.
Error EmptyIntervalError(const std::filesystem::path& path, const events::Interval& interval, TimeNs first,
                         TimeNs last);

/// Faults of an event with their remedies, to follow the place in a message.
std::string TimeBackwardsMessage(TimeNs previous, TimeNs t);
std::string OffSensorMessage(double x, double y, int width, int height);

}  // namespace evo::io
