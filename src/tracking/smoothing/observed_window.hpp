#pragma once

#include <Eigen/Core>

namespace evo::tracking {

/// The window of events, centred on an observation's stamp, that the observed position averages over.
struct ObservedWindow {
  float half_s = 0.0f;                             ///< half of its length, s; 0: the position is that of an instant
  Eigen::Vector2f flow = Eigen::Vector2f::Zero();  ///< px/s, measured from its events alone
};

}  // namespace evo::tracking
