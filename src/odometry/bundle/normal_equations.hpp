#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/geometry/se3.hpp"
#include "odometry/bundle/block_skyline_matrix.hpp"
#include "odometry/bundle/bundle_problem.hpp"
#include "odometry/bundle/linearized_track.hpp"
#include "odometry/bundle/point_batches.hpp"

namespace evo::odometry {

/// The normal equations of a bundle problem at its present values. The points are eliminated by Schur's complement
/// (B. Triggs, P. McLauchlan, R. Hartley, A. Fitzgibbon: Bundle Adjustment - A Modern Synthesis, 1999).
class NormalEquations {
 public:
  /// `first_observations` as FirstObservations returns them. All arguments must outlive this object. The present
  /// distance of the scale frame is the one that is held.
  NormalEquations(const BundleProblem& problem, const NoiseModel& noise,
                  const std::vector<std::size_t>& first_observations, ThreadPool* pool);

  void Linearize();

  /// Steps of the free poses (left twists) and the points for the damping `lambda`; false if the system is singular.
  bool Solve(double lambda, Eigen::VectorXd* pose_steps, std::vector<Eigen::Vector3d>* point_steps);

  /// Reduces and factorises the system without damping; false if it is singular.
  bool Factorize();
  /// After Factorize(): the poses' steps if every track's part of the gradient is multiplied by `signs[point]`.
  Eigen::VectorXd SolveWithSigns(const std::vector<double>& signs) const;

 private:
  /// A point's own part of the equations.
  struct PointPart {
    Eigen::Matrix3d hessian;
    Eigen::Matrix3d inverse_hessian;  ///< damped
    Eigen::Vector3d gradient;
  };
  /// An observation's part: zero for a fixed pose.
  struct ObservationPart {
    Eigen::Matrix<double, 6, 3> pose_point_hessian;
    geometry::Vector6d pose_gradient = geometry::Vector6d::Zero();
  };

  /// Row of the observation's pose; negative if that is fixed.
  int PoseRow(std::size_t observation) const {
    return problem_.observations[observation].frame - problem_.fixed_frames;
  }
  void LinearizePoint(std::size_t p);
  void LinearizeScale();
  void LinearizeMotion();
  /// Sets the reduced system and its right side.
  void Reduce(double lambda, Eigen::VectorXd* right);
  void EliminatePoint(std::size_t p, double lambda, Eigen::VectorXd* right);

  const BundleProblem& problem_;
  const NoiseModel& noise_;
  const std::vector<std::size_t>& begin_;  // first observation of every point
  PointBatches batches_;
  double held_distance_;
  BlockSkylineMatrix pose_hessian_;
  BlockSkylineMatrix reduced_hessian_;  // Schur's complement, or its factor
  Eigen::VectorXd pose_gradient_;
  std::vector<PointPart> points_;
  std::vector<ObservationPart> observations_;
};

}  // namespace evo::odometry
