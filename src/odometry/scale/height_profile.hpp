#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "odometry/scale/ground_likelihood.hpp"

namespace evo::odometry {

struct HeightProfileOptions {
  double scale_drift = 0.0;          ///< standard deviation of the scale's relative change over an arc of unit length
  double roll_drift = 0.0;           ///< standard deviation of the roll's change over an arc of one height, rad
  double path_length = 0.0;          ///< arc length
  std::vector<double> scale_breaks;  ///< arc lengths at which the scale was lost
};

/// How well the ground is known.
struct HeightProfileQuality {
  double evidence = 0.0;        ///< logarithm of the likelihood over that without a ground
  std::size_t inliers = 0;      ///< observations on the ground
  double covered_ratio = 0.0;   ///< part of the path where the height is known within a percent
  double relative_sigma = 0.0;  ///< standard deviation of the height over the height, median along the path
};

/// The height of a path above the ground by arc length, piecewise linear in the inverse height.
struct HeightProfile {
  double spacing = 0.0;                 ///< arc length between the nodes, of which there are at least two
  std::vector<double> inverse_heights;  ///< at each node
  std::vector<double> rolls;            ///< of the ground against the camera at each node, rad
  double path_length_in_heights = 0.0;  ///< arc length of the path over the typical height
  HeightProfileQuality quality;

  double InverseHeight(double arc_length) const;
};

/// Fits the ground that explains the observations best: a random walk of height and roll along the path, where an
/// observation lies on the ground or, with a density learned from all of them, off it, which is mostly above. Empty if
/// there are too few observations on it, if they scatter far more than their noise explains, if neighbours err alike,
/// if the likelihood is hardly higher than without a ground or if there are observations on less than half the path:
/// then there is no ground, or the height is not constant.
std::optional<HeightProfile> FitHeightProfile(const HeightProfileOptions& options,
                                              const std::vector<GroundObservation>& observations);

}  // namespace evo::odometry
