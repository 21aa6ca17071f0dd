#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "evo/geometry/se3.hpp"

namespace evo::geometry {

/// One point in two views, undistorted, on the normalized planes z = 1.
struct Correspondence {
  Eigen::Vector2d x1;
  Eigen::Vector2d x2;
};

/// The essential matrix E = t^ R with x2^T E x1 = 0 (D. Zhu, equations 10-13) by the normalised eight-point algorithm
/// (R. I. Hartley: In Defense of the Eight-Point Algorithm, PAMI 1997), with singular values (1, 1, 0). Empty for fewer
/// than eight pairs or coinciding points.
std::optional<Eigen::Matrix3d> EightPoint(std::span<const Correspondence> pairs);

/// The four motions T_2_1 with |t| = 1 and t^ R = +-E (R. Hartley, A. Zisserman: Multiple View Geometry, 9.19).
std::array<SE3, 4> DecomposeEssential(const Eigen::Matrix3d& essential);

/// The essential matrix t^ R (D. Zhu, equation 10).
Eigen::Matrix3d EssentialMatrix(const SE3& T_2_1);

/// The signed first-order distance of a pair from the epipolar constraint (Multiple View Geometry, 11.9) on the
/// normalized plane z = 1.
double SampsonError(const Eigen::Matrix3d& essential, const Correspondence& pair);

/// Gauss-Newton on the Sampson error over the rotation and the direction of the translation (five degrees of freedom).
SE3 RefineRelativePose(std::span<const Correspondence> pairs, const SE3& T_2_1);

struct RelativePoseOptions {
  double max_sampson_error = 0.004;  ///< of an inlier, on the normalized plane z = 1: px over focal length
  int max_samples = 300;             ///< of RANSAC
  double confidence = 0.999;         ///< that one sample has no outlier
  std::uint32_t seed = 1;            ///< of the samples
};

struct RelativePose {
  SE3 T_2_1;                  ///< |t| = 1
  std::vector<bool> inliers;  ///< small Sampson error and in front of both cameras
  int inlier_count = 0;
};

/// Estimates the motion between two views by RANSAC over eight-point samples and refines it on its inliers. The same
/// input gives the same result on every machine. Empty if no motion has eight inliers.
std::optional<RelativePose> EstimateRelativePose(std::span<const Correspondence> pairs,
                                                 const RelativePoseOptions& options);

}  // namespace evo::geometry
