#pragma once

#include "evo/core/time.hpp"

namespace evo::events {

/// The end of the bin that holds `t`, given the end of an earlier one: skips all bins of a silence at once.
inline TimeNs BinEndAfter(TimeNs t, TimeNs bin_end, TimeNs length) {
  return bin_end + ((t - bin_end) / length + 1) * length;
}

}  // namespace evo::events
