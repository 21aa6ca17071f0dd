#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace evo::odometry {

/// A track below the path, which may lie on the ground. All by the inverse of its depth below the path: the noise of a
/// track moves it along its ray, and there the inverse depth has an error that is the same wherever the noise has put
/// the track, and no bias.
struct GroundSighting {
  double along = 0.0;           ///< way along the path to where the track lies beside it
  double inverse_height = 0.0;  ///< one over the depth below the path
  double sigma = 0.0;           ///< its standard deviation, up to a factor that is common to all
  double sideways = 0.0;        ///< to the right of the path, in depths below it
};

struct GroundProfileOptions {
  double drift = 0.0;          ///< standard deviation of the height's change over a way of one height, relative
  double length = 0.0;         ///< of the path
  std::vector<double> breaks;  ///< ways along the path at which the scale was lost
};

/// The height of a path above the ground, along the path.
struct GroundProfile {
  double spacing = 0.0;                ///< between the nodes, of which there are at least two
  std::vector<double> inverse_height;  ///< at each node
  double roll = 0.0;                   ///< of the ground against the camera, rad
  std::size_t tracks = 0;              ///< that lie on the ground
  double covered = 0.0;                ///< share of the path where the height is known within a percent
  double error = 0.0;                  ///< relative standard deviation of the height, median over the path
  double heights = 0.0;                ///< length of the path in heights

  double InverseHeight(double along) const;
};

/// The profile that the most sightings agree with, smoothed as the drift allows: a random walk of the height along the
/// path, by least squares with Tukey's weights, from coarse to fine. Empty if there are too few sightings, if they
/// scatter far more than their noise explains, or if on more than a tenth of the path fewer than half of them agree:
/// then there is no ground, or the height is not constant.
std::optional<GroundProfile> FitGround(const GroundProfileOptions& options,
                                       const std::vector<GroundSighting>& sightings);

}  // namespace evo::odometry
