#pragma once

#include <string>

#include "evo/core/time.hpp"

namespace evo::io {

/// The fault of stamps that do not strictly increase, with the remedy, to follow the place in a message.
inline std::string UnorderedStampsMessage(TimeNs previous, TimeNs t) {
  return "the stamp " + FormatTime(t) + " s is not later than the one before, " + FormatTime(previous) +
         " s; sort the poses by time and drop repeated ones";
}

}  // namespace evo::io
