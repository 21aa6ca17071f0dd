#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "evo/geometry/se3.hpp"

namespace evo::geometry {

/// One point seen by two cameras, undistorted, on their planes z = 1.
struct Correspondence {
  Eigen::Vector2d x1;
  Eigen::Vector2d x2;
};

/// E with x2^T E x1 = 0 (the paper's equations 10-13) by Hartley's normalised eight-point algorithm, with singular
/// values (1, 1, 0). Empty for fewer than eight pairs or coinciding points.
std::optional<Eigen::Matrix3d> EightPoint(std::span<const Correspondence> pairs);

/// The four motions T_2_1 with |t| = 1 whose t^ R is +-E.
std::array<SE3, 4> DecomposeEssential(const Eigen::Matrix3d& essential);

/// t^ R.
Eigen::Matrix3d Essential(const SE3& T_2_1);

/// First-order distance of a pair to the epipolar constraint, signed, in units of the plane z = 1.
double SampsonError(const Eigen::Matrix3d& essential, const Correspondence& pair);

/// Gauss-Newton on the Sampson error over rotation and direction of translation (five degrees of freedom).
SE3 RefineRelativePose(std::span<const Correspondence> pairs, const SE3& T_2_1);

struct RelativePoseOptions {
  double threshold = 0.004;  ///< largest Sampson error of an inlier on the plane z = 1: pixels over focal length
  int iterations = 300;      ///< RANSAC samples at most
  double confidence = 0.999;
  std::uint32_t seed = 1;
};

struct RelativePose {
  SE3 T_2_1;                  ///< |t| = 1
  std::vector<bool> inliers;  ///< within the threshold and in front of both cameras
  int inlier_count = 0;
};

/// The motion between two views by RANSAC over eight-point samples, then refined on its inliers. The same input gives
/// the same result everywhere. Empty when no motion puts eight pairs in front of both cameras.
std::optional<RelativePose> EstimateRelativePose(std::span<const Correspondence> pairs,
                                                 const RelativePoseOptions& options);

}  // namespace evo::geometry
