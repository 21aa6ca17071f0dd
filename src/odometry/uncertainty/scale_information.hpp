#pragma once

#include <vector>

#include "evo/geometry/se3.hpp"
#include "odometry/uncertainty/pose_error_samples.hpp"

namespace evo::odometry {

/// The scale along a path, known from elsewhere than the tracks: a first-order Gauss-Markov process.
struct ScaleInformation {
  double relative_sigma = 0.0;      ///< standard deviation of the scale
  double correlation_length = 0.0;  ///< arc length over which the error's correlation falls to 1 / e, poses' unit
};

/// The drift of the scale that the tracks leave: standard deviation of its relative change over an arc of unit length
/// (that of the poses), from the change between means over `window`; 0 if the path is shorter than two windows.
double EstimateScaleDrift(const PoseErrorSamples& errors, double window);

/// Replaces what the tracks tell of the scale over the correlation length by this information. `T_cam_world` are the
/// poses with the new scale, of the same rotations.
void ApplyScaleInformation(const ScaleInformation& information, std::vector<geometry::SE3> T_cam_world,
                           PoseErrorSamples* errors);

}  // namespace evo::odometry
