#pragma once

#include <Eigen/Core>

namespace evo::tracking {

/// Position and optical flow of a feature.
struct FlowSample {
  Eigen::Vector2d position;  ///< px
  Eigen::Vector2d flow;      ///< px/s
};

}  // namespace evo::tracking
