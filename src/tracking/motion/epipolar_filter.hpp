#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tracking/motion/camera_motion.hpp"
#include "tracking/motion/lens_grid.hpp"

namespace evo::tracking {

/// A feature from one frame to the next, px.
struct FeatureStep {
  Eigen::Vector2d before;      ///< where the filter had it
  Eigen::Vector2d now;         ///< where its own events put it
  double inverse_depth = 0.0;  ///< in units of the speed, 1/s; 0: not known
};

/// Takes from the positions of resting features what they err by across their epipolar lines. A feature drifts along
/// and across its line alike, but where the lines are, all features know together: one turn of the camera and one
/// change of its heading explain all true motion across them. The rest is an error, and is corrected as a Kalman
/// filter would that expects the heading to change as much as it usually does: hardly in a car, where the errors
/// average out over half a second, so much in a hand that each position stays as its own events tell it.
class EpipolarFilter {
 public:
  /// The positions now. `motion` is that before this step; a step without an inverse depth, one near where the camera
  /// heads, and one that deviates by pixels, as of a thing that moves by itself, keeps its own position.
  std::vector<Eigen::Vector2d> Filter(const CameraMotion& motion, const LensGrid& lens, double step_s,
                                      std::span<const FeatureStep> steps);

 private:
  double heading_change_ = 0.1;  ///< usual, of the heading from frame to frame, rad
};

}  // namespace evo::tracking
