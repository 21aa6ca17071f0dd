#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tracking/motion/camera_motion.hpp"
#include "tracking/motion/jacobian_table.hpp"

namespace evo::tracking {

/// Motion of a feature from one frame to the next.
struct FeatureStep {
  Eigen::Vector2d previous;    ///< filtered position in the last frame, px
  Eigen::Vector2d measured;    ///< position in this frame, from the feature's own events, px
  double inverse_depth = 0.0;  ///< in units of the speed, 1/s; 0: unknown
};

/// Motion of a feature across its epipolar line in one step.
struct EpipolarDeviation {
  using Correction =
      Eigen::Matrix<double, 5, 1>;  ///< of the rotation (rad) and the direction along both tangents (rad)

  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< of the line
  double value = 0.0;                                ///< along the normal, px
  Correction jacobian = Correction::Zero();
  double baseline_px = 0.0;  ///< motion along the line that the translation causes in this step

  bool observable() const { return baseline_px > 0.0; }
};

/// Not observable near the focus of expansion or where the inverse depth is unknown.
EpipolarDeviation ComputeEpipolarDeviation(const CameraMotion& motion, const CameraMotion::Tangents& tangents,
                                           const JacobianTable& jacobians, double step_s, const FeatureStep& step);

/// Reduces the position errors of static features across their epipolar lines. The errors along and across a line are
/// alike, but all features together know the lines: one rotation and one change of the camera's direction explain all
/// true motion across them, and the rest is error. Each feature is corrected by a Kalman filter in its steady state
/// that expects the direction to change as much as it did lately: in a car hardly, so the errors average out over half
/// a second; in a hand so much that each position stays as its own events tell.
class EpipolarFilter {
 public:
  /// Returns the positions in this frame. `motion` is that of the last frame. A step keeps its measured position if its
  /// deviation is not observable or is of pixels, as of a moving object.
  std::vector<Eigen::Vector2d> Filter(const CameraMotion& motion, const JacobianTable& jacobians, double step_s,
                                      std::span<const FeatureStep> steps);

 private:
  double direction_change_ = 0.1;  // typical, from frame to frame, rad
};

}  // namespace evo::tracking
