#pragma once

#include <Eigen/Core>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "tracking/motion/camera_motion.hpp"
#include "tracking/motion/flow_sample.hpp"
#include "tracking/motion/jacobian_table.hpp"

namespace evo::tracking {

/// Motion field of a planar patch, to second order: a point at y px from the patch's centre moves, relative to the
/// centre, with linear_rate * y + (quadratic_rate . y) y. A plane has no other second-order terms (G. Adiv: Determining
/// Three-Dimensional Motion and Structure from Optical Flow, PAMI 1985).
struct PatchFlow {
  Eigen::Vector2d acceleration = Eigen::Vector2d::Zero();    ///< of the centre, px/s^2
  Eigen::Matrix2d linear_rate = Eigen::Matrix2d::Zero();     ///< 1/s
  Eigen::Vector2d quadratic_rate = Eigen::Vector2d::Zero();  ///< foreshortening, 1/(px s)
};

/// The camera's own motion, from the optical flow of many features. A static point at x on the plane z = 1 with inverse
/// depth rho moves with rho (v_z x - v_xy) and with the rotation (see CameraMotion). Only the direction of the velocity
/// v is observable, so inverse depths are in units of the speed, 1/s.
class EgoMotion {
 public:
  explicit EgoMotion(const geometry::Camera& camera) : jacobians_(camera) {}

  /// Estimates the motion from the flows of features, `step_s` after the last call, by iteratively reweighted
  /// Gauss-Newton from the last motion on. A Kalman filter keeps it smooth unless the direction jumps.
  void Update(const std::vector<FlowSample>& features, double step_s);
  /// Whether the last flows determined a motion with a direction.
  bool known() const { return known_; }
  const CameraMotion& motion() const { return motion_; }
  const JacobianTable& jacobians() const { return jacobians_; }
  const Eigen::Vector3d& direction() const { return motion_.direction; }
  /// Of the world about the camera, rad/s.
  const Eigen::Vector3d& angular_velocity() const { return motion_.angular_velocity; }
  /// Change of the angular velocity, rad/s^2: the mean over the last frames.
  double typical_angular_acceleration() const { return typical_angular_acceleration_; }

  /// Flow of a static point, px/s.
  Eigen::Vector2d PredictFlow(const Eigen::Vector2d& position, double inverse_depth) const {
    return motion_.PredictFlow(jacobians_.Lookup(position), inverse_depth);
  }
  /// Inverse depth of a static point with this flow, 1/s; 0 while the motion is unknown.
  double EstimateInverseDepth(const FlowSample& feature) const;
  /// The point's inverse depth `step_s` later.
  double PropagateInverseDepth(double inverse_depth, double step_s) const {
    return inverse_depth * (1.0 + step_s * inverse_depth * motion_.direction.z());
  }
  /// The feature's flow, moved towards the epipolar line along which a static point moves, px/s. A flow too far from
  /// the line stays, since its point is not static.
  Eigen::Vector2d ProjectToEpipolarLine(const FlowSample& feature) const;
  /// The motion field around a feature on a plane whose inverse depth has this gradient, 1/(px s).
  PatchFlow PredictPatchFlow(const FlowSample& feature, const Eigen::Vector2d& inverse_depth_gradient) const;
  /// Whether a static point may have this flow; true while the motion is unknown.
  bool MayBeStatic(const FlowSample& feature) const;
  /// The gradient of inverse depth, 1/(px s), that best explains a `residual_rate` (1/s): a patch's linear rate beyond
  /// the predicted one. 0 where it is unobservable.
  Eigen::Vector2d EstimateInverseDepthGradient(const Eigen::Vector2d& position,
                                               const Eigen::Matrix2d& residual_rate) const;

 private:
  /// Prediction of the motion. The information is over (direction, angular velocity), in units of a flow's.
  struct Prior {
    CameraMotion motion;
    geometry::Matrix6d information = geometry::Matrix6d::Zero();
  };

  /// Where the search for the motion starts.
  std::vector<Eigen::Vector3d> StartDirections();
  /// Sets the motion that explains the flows best; unknown if none does.
  void Search(const std::vector<FlowSample>& features, const std::vector<PixelJacobians>& pixels);
  /// Returns the mean robust loss of the flows, from 0 to 1.
  double Refine(const std::vector<FlowSample>& features, const std::vector<PixelJacobians>& pixels, const Prior& prior,
                int iterations);
  /// Chooses the sign of the direction; sets the motion to unknown where too few flows have a translational part.
  void ResolveSign(const std::vector<FlowSample>& features, const std::vector<PixelJacobians>& pixels);

  JacobianTable jacobians_;
  std::size_t next_start_ = 0;  // counts calls
  bool known_ = false;
  CameraMotion motion_;
  geometry::Matrix6d covariance_ = geometry::Matrix6d::Zero();  // over (direction, angular velocity)
  double typical_angular_acceleration_ = 0.0;
};

}  // namespace evo::tracking
