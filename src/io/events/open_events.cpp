#include "evo/io/open_events.hpp"
#include "evo/core/number.hpp"
#include "evo/events/event_reader.hpp"

#include <limits>
#include <string>

#include "evo/io/file_kind.hpp"
#include "evo/io/sequence.hpp"
#include "io/events/event_reader_parts.hpp"
#include "io/text_lines.hpp"

namespace evo::io {

TimeNs Later(TimeNs first, TimeNs offset) {
  TimeNs sum = 0;
  return __builtin_add_overflow(first, offset, &sum) ? std::numeric_limits<TimeNs>::max() : sum;
}

Error NothingInInterval(const std::filesystem::path& path, const events::Interval& interval, TimeNs first,
                        TimeNs last) {
  const std::string to = interval.to ? FormatTime(*interval.to) + " s" : "the end";
  return {ErrorKind::kNothingToDo, path.string() + ": no events from " + FormatTime(interval.from) + " s to " + to +
                                       "; the recording is " + FormatTime(last - first) +
                                       " s long, choose --from and --to within it"};
}

std::string BackwardsMessage(TimeNs previous, TimeNs t) {
  return "time runs backwards, from " + FormatTime(previous) + " s to " + FormatTime(t) + " s; sort the events by time";
}

std::string OffSensorMessage(double x, double y, int width, int height) {
  return "pixel (" + FormatNumber(x) + ", " + FormatNumber(y) + ") is outside the " + std::to_string(width) + " x " +
         std::to_string(height) +
         " px sensor of the calibration; the recording and the calibration do not fit together";
}

std::unique_ptr<events::EventReader> OpenEvents(const std::filesystem::path& path, const events::Interval& interval,
                                                int width, int height) {
  const std::filesystem::path file = FindSequence(path).events;
  RequireKind(file, {FileKind::kHdf5, FileKind::kEventText}, "an MVSEC .hdf5 or a UZH events.txt");
  return DetectKind(file) == FileKind::kHdf5 ? OpenMvsecEvents(file, interval, width, height)
                                             : OpenTextEvents(file, interval, width, height);
}

}  // namespace evo::io
