#pragma once

#include <filesystem>
#include <memory>

#include "evo/events/event_reader.hpp"

namespace evo::io {

/// Opens an MVSEC .hdf5 (left DAVIS), a UZH events.txt or a folder that holds either; the kind is told by content.
/// `width` x `height` px is the sensor that the calibration promises.
///
/// MVSEC: `davis/left/events`, N x 4 of x y t p in any numeric type and any layout; t in seconds. An integer type
/// cannot hold seconds: its stamps are taken as epoch micro- or nanoseconds where their size tells which, and refused
/// otherwise. A block is a whole number of chunks, so nothing is inflated twice; a single huge chunk is held in memory.
/// UZH: lines `t x y p`, t in seconds, exact to the nanosecond.
/// Both: p is 1, and 0 or -1 for darker. The interval's ends are found by bisection, without reading what lies before.
///
/// Throws Error: kInput for a missing, unreadable or foreign file, kNothingToDo if no event lies in the interval.
std::unique_ptr<events::EventReader> OpenEvents(const std::filesystem::path& path, const events::Interval& interval,
                                                int width, int height);

}  // namespace evo::io
