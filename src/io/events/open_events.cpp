#include "evo/io/open_events.hpp"

#include <limits>

#include "evo/io/file_kind.hpp"
#include "evo/io/sequence.hpp"
#include "io/events/event_readers.hpp"

namespace evo::io {

TimeNs SaturatedSum(TimeNs first, TimeNs offset) {
  TimeNs sum = 0;
  return __builtin_add_overflow(first, offset, &sum) ? std::numeric_limits<TimeNs>::max() : sum;
}

std::unique_ptr<events::EventReader> OpenEvents(const std::filesystem::path& path, const events::Interval& interval,
                                                int width, int height) {
  const std::filesystem::path file = FindSequence(path).events;
  RequireKind(file, {FileKind::kHdf5, FileKind::kEventText}, "an MVSEC .hdf5 or a UZH events.txt");
  return DetectKind(file) == FileKind::kHdf5 ? OpenMvsecEvents(file, interval, width, height)
                                             : OpenTextEvents(file, interval, width, height);
}

}  // namespace evo::io
