#include "io/events/event_errors.hpp"

#include <fmt/format.h>

#include "evo/core/number.hpp"

namespace evo::io {

Error EmptyIntervalError(const std::filesystem::path& path, const events::Interval& interval, TimeNs first,
                         TimeNs last) {
  const std::string to = interval.to ? FormatTime(*interval.to) + " s" : "the end";
  return {ErrorKind::kNothingToDo,
          fmt::format("{}: no events from {} s to {}; the recording is {} s long, choose --from and --to within it",
                      path.string(), FormatTime(interval.from), to, FormatTime(last - first))};
}

std::string TimeBackwardsMessage(TimeNs previous, TimeNs t) {
  return fmt::format("time runs backwards, from {} s to {} s; sort the events by time", FormatTime(previous),
                     FormatTime(t));
}

std::string OffSensorMessage(double x, double y, int width, int height) {
  return fmt::format(
      "pixel ({}, {}) is outside the {} x {} px sensor of the calibration; give the calibration of this recording",
      FormatNumber(x), FormatNumber(y), width, height);
}

}  // namespace evo::io
