#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "evo/core/error.hpp"
#include "evo/events/event_reader.hpp"

namespace evo::io {

/// What each kind of recording brings to OpenEvents; contracts as there.
std::unique_ptr<events::EventReader> OpenMvsecEvents(const std::filesystem::path& path,
                                                     const events::Interval& interval, int width, int height);
std::unique_ptr<events::EventReader> OpenTextEvents(const std::filesystem::path& path, const events::Interval& interval,
                                                    int width, int height);

/// first + offset, or the largest stamp where that does not fit.
TimeNs Later(TimeNs first, TimeNs offset);

/// No event in the interval: kNothingToDo, with how long the recording is.
Error NothingInInterval(const std::filesystem::path& path, const events::Interval& interval, TimeNs first, TimeNs last);

/// What to say of events that the readers refuse; each ends with the remedy and continues a message about the place.
std::string BackwardsMessage(TimeNs previous, TimeNs t);
std::string OffSensorMessage(double x, double y, int width, int height);

}  // namespace evo::io
