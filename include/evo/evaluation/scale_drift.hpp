#pragma once

namespace evo {

/// The local scale of an estimate at one pose.
struct ScaleSample {
  double seconds = 0.0;   ///< since the start of the interval
  double distance = 0.0;  ///< m that the truth has travelled since the first pair
  double ratio = 0.0;     ///< true length over aligned length around the pose; NaN where it is not determined
};

}  // namespace evo
