#pragma once

#include <Eigen/Core>

namespace evo::tracking {

/// The window of events around the stamp of an observation that its position comes from.
struct ObservedWindow {
  float half_s = 0.0f;                             ///< half of its length; 0: the position is that of an instant
  Eigen::Vector2f flow = Eigen::Vector2f::Zero();  ///< px/s, as its events alone tell it
};

}  // namespace evo::tracking
