#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace evo::odometry {

/// A track below the path, which may lie on the ground. It is described by its inverse depth below the path: noise
/// moves a track along its ray, and the error of its inverse depth is unbiased and independent of where the noise has
/// put it.
struct GroundObservation {
  double arc_length = 0.0;      ///< of the path's place above the track
  double inverse_height = 0.0;  ///< 1 / depth below the path
  double sigma = 0.0;           ///< standard deviation of the inverse height, up to a factor common to all
  double lateral_ratio = 0.0;   ///< offset to the right of the path over the depth below it
};

struct HeightProfileOptions {
  double scale_drift_ratio = 0.0;    ///< standard deviation of the height's relative change over an arc of one height
  double path_length = 0.0;          ///< arc length
  std::vector<double> scale_breaks;  ///< arc lengths at which the scale was lost
};

/// How well the ground is known.
struct HeightProfileQuality {
  std::size_t inliers = 0;      ///< observations on the ground
  double covered_ratio = 0.0;   ///< part of the path where the height is known within a percent
  double relative_sigma = 0.0;  ///< standard deviation of the height over the height, median along the path
};

/// The height of a path above the ground by arc length, piecewise linear in the inverse height.
struct HeightProfile {
  double spacing = 0.0;                 ///< arc length between the nodes, of which there are at least two
  std::vector<double> inverse_heights;  ///< at each node
  double roll = 0.0;                    ///< of the ground against the camera, rad
  double path_length_in_heights = 0.0;  ///< arc length of the path over the typical height
  HeightProfileQuality quality;

  double InverseHeight(double arc_length) const;
};

/// Fits the profile that the most observations agree with: a random walk of the height along the path, by least squares
/// with Tukey's weights, from coarse to fine. Empty if there are too few observations, if they scatter far more than
/// their noise explains, or if on more than a tenth of the path less than half of them agree: then there is no ground,
/// or the height is not constant.
std::optional<HeightProfile> FitHeightProfile(const HeightProfileOptions& options,
                                              const std::vector<GroundObservation>& observations);

}  // namespace evo::odometry
