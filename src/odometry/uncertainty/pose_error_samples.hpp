#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "evo/geometry/se3.hpp"

namespace evo::odometry {

/// Poses [begin, end).
struct PoseRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Samples of the joint errors of many poses, from which the covariance between any two of them can be computed without
/// storing all. An error is a left twist of T_cam_world (translation in the poses' unit, rotation in rad).
class PoseErrorSamples {
 public:
  /// A column a sample.
  using Twists = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  /// Without errors yet.
  PoseErrorSamples(std::vector<geometry::SE3> T_cam_world, Eigen::Index samples);

  std::size_t poses() const { return T_cam_world_.size(); }
  Eigen::Index samples() const { return twists_.cols(); }
  const std::vector<geometry::SE3>& T_cam_world() const { return T_cam_world_; }

  /// The errors of pose `pose`.
  auto twists(std::size_t pose) { return twists_.middleRows<6>(Row(pose)); }
  auto twists(std::size_t pose) const { return twists_.middleRows<6>(Row(pose)); }
  /// The errors of all poses in one sample, six rows a pose.
  auto sample(Eigen::Index k) { return twists_.col(k); }

  /// The displacement of a camera's centre in one sample, world.
  Eigen::Vector3d CentreError(std::size_t pose, Eigen::Index sample) const;
  void SetCentreError(std::size_t pose, Eigen::Index sample, const Eigen::Vector3d& error);

  /// Removes all other poses.
  void KeepRange(PoseRange range);
  /// Replaces the poses by as many with the same rotations.
  void SetPoses(std::vector<geometry::SE3> T_cam_world) { T_cam_world_ = std::move(T_cam_world); }

  /// Covariances of all poses relative to `origin`, whose own is zero. The scale is that of the poses or, if
  /// `scale_is_free`, the one that fits the true path best by least squares with the origin fixed, as an alignment with
  /// free scale does.
  std::vector<geometry::Matrix6d> Covariances(std::size_t origin, bool scale_is_free) const;

  /// Standard deviation of the camera's rotation from one pose to another, rad (root of the trace).
  double RotationSigma(std::size_t from, std::size_t to) const;

 private:
  static Eigen::Index Row(std::size_t pose) { return 6 * static_cast<Eigen::Index>(pose); }
  /// Errors of a pose relative to those of `origin`.
  Twists RelativeTwists(std::size_t pose, std::size_t origin) const;

  std::vector<geometry::SE3> T_cam_world_;
  Eigen::MatrixXd twists_;  // six rows a pose
};

/// Positions of the cameras, world.
std::vector<Eigen::Vector3d> CameraCentres(const std::vector<geometry::SE3>& T_cam_world);

}  // namespace evo::odometry
