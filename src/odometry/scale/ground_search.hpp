#pragma once

#include <cstddef>
#include <vector>

#include "odometry/scale/ground_likelihood.hpp"

namespace evo::odometry {

/// The path cut into sections of equal length.
struct GroundSections {
  std::vector<std::size_t> section;  ///< of each observation
  std::vector<double> step_sigmas;   ///< relative change of the height from each section to the next
};

/// A ground along the path, found among all heights and rolls that are possible.
struct FoundGround {
  std::vector<double> log_inverse_heights;  ///< of each section
  double roll = 0.0;                        ///< of the ground against the camera, rad
  double evidence = 0.0;                    ///< logarithm of the likelihood over that without a ground
};

/// The most likely ground: by dynamic programming over the sections for every roll (A. J. Viterbi, IEEE Trans.
/// Information Theory 1967). `observations` may not be empty.
FoundGround SearchGround(const std::vector<GroundObservation>& observations, const GroundSections& sections);

}  // namespace evo::odometry
