#pragma once

#include <Eigen/Core>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "tracking/motion/camera_motion.hpp"
#include "tracking/motion/flow_sample.hpp"
#include "tracking/motion/lens_grid.hpp"

namespace evo::tracking {

/// How a patch of a plane changes while the camera moves, to second order: a point at y px from the patch's centre
/// moves, relative to the centre, with rate * y + (bend . y) y.
struct PatchFlow {
  Eigen::Vector2d acceleration = Eigen::Vector2d::Zero();  ///< of the centre, px/s^2
  Eigen::Matrix2d rate = Eigen::Matrix2d::Zero();          ///< 1/s
  Eigen::Vector2d bend = Eigen::Vector2d::Zero();          ///< 1/(px s), of foreshortening
};

/// The camera's own motion, from the optical flow of many features: a point at x on the plane z = 1 with inverse depth
/// rho moves with rho (V_z x - V_xy) and with the rotation (H. C. Longuet-Higgins, K. Prazdny: The Interpretation of a
/// Moving Retinal Image, Proc. R. Soc. B 1980). Only the direction of V can be known, so inverse depths are in units of
/// the speed, 1/s.
class EgoMotion {
 public:
  explicit EgoMotion(const geometry::Camera& camera) : lens_(camera) {}

  /// Finds the motion from the flows of features `step_s` after the last, by iteratively reweighted Gauss-Newton from
  /// the last motion on. Where it goes on, it is filtered: it changes little in so short a time.
  void Update(const std::vector<FlowSample>& features, double step_s);
  /// Whether the flows determined a motion with a direction.
  bool known() const { return known_; }
  const CameraMotion& motion() const { return motion_; }
  const LensGrid& lens() const { return lens_; }
  const Eigen::Vector3d& direction() const { return motion_.direction; }
  const Eigen::Vector3d& turn_rate() const { return motion_.turn_rate; }  ///< of the world about the camera, rad/s

  /// How much the turn rate usually changes, rad/s^2: the mean over the last frames.
  double turn_change() const { return turn_change_; }
  /// Of a resting point with this inverse depth, px/s.
  Eigen::Vector2d Flow(const Eigen::Vector2d& position, double inverse_depth) const {
    return motion_.Flow(lens_.At(position), inverse_depth);
  }
  /// Of a point with this flow; 0 while the motion is not known.
  double InverseDepth(const FlowSample& feature) const;
  /// The same point's inverse depth `step_s` later.
  double Advanced(double inverse_depth, double step_s) const {
    return inverse_depth * (1.0 + step_s * inverse_depth * motion_.direction.z());
  }
  /// The feature's flow with less of its error across the line along which the camera's translation moves a resting
  /// point; what is too large for an error is left, since then the point does not rest.
  Eigen::Vector2d AtRest(const FlowSample& feature) const;
  /// Of a plane whose inverse depth has the gradient `slope`, 1/(px s), where a feature has this flow.
  PatchFlow At(const FlowSample& feature, const Eigen::Vector2d& slope) const;
  /// Whether a resting point may move like this while the camera does; true while the motion is not known.
  bool Allows(const FlowSample& feature) const;
  /// The slope that explains best that a patch's rate is `rate` more than At() said; 0 where nothing tells.
  Eigen::Vector2d SlopeOf(const Eigen::Vector2d& position, const Eigen::Matrix2d& rate) const;

 private:
  /// What the motion before says; matrices are over direction and turn rate.
  struct Expectation {
    CameraMotion motion;
    geometry::Matrix6d information = geometry::Matrix6d::Zero();  ///< in what a flow tells
  };

  /// Returns the mean of the robust loss that is left, from 0 to 1.
  double Refine(const std::vector<FlowSample>& features, const std::vector<PixelGeometry>& pixels,
                const Expectation& expected, int iterations);

  /// Chooses the sign of the direction, or says that there is none.
  void Orient(const std::vector<FlowSample>& features, const std::vector<PixelGeometry>& pixels);

  LensGrid lens_;
  std::size_t next_start_ = 0;  // counts
  bool known_ = false;
  CameraMotion motion_;
  geometry::Matrix6d covariance_ = geometry::Matrix6d::Zero();
  double turn_change_ = 0.0;
};

}  // namespace evo::tracking
