#pragma once

#include <filesystem>
#include <memory>

#include "evo/events/event_reader.hpp"

namespace evo::io {

/// Opens an MVSEC .hdf5 (left DAVIS), a UZH events.txt or a folder with either; the content tells the format.
/// `width` x `height` px is the calibrated sensor.
///
/// MVSEC: `davis/left/events`, N x 4 of x y t p in any numeric type and layout, t in seconds. Integer stamps are epoch
/// micro- or nanoseconds, told by their size, and refused otherwise. A block is a whole number of chunks, so that no
/// chunk is decoded twice; memory holds a single huge chunk.
/// UZH: lines `t x y p`, t in seconds, exact to the nanosecond.
/// Both: p is 1 for brighter, 0 or -1 for darker. Bisection finds the ends of the interval.
///
/// Throws Error: kInput for a missing, unreadable or foreign file, kNothingToDo if no event lies in the interval.
std::unique_ptr<events::EventReader> OpenEvents(const std::filesystem::path& path, const events::Interval& interval,
                                                int width, int height);

}  // namespace evo::io
