#pragma once

#include <Eigen/Core>

namespace evo::tracking {

/// Position and optical flow of a tracked feature, from which a flow field starts.
struct FlowSample {
  Eigen::Vector2d position;  ///< px
  Eigen::Vector2d flow;      ///< px/s
};

}  // namespace evo::tracking
