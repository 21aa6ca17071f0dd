#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "evo/geometry/se3.hpp"

namespace evo::geometry {

/// The depths (z coordinates) of one point in two views.
struct PairDepths {
  double z1 = 0.0;
  double z2 = 0.0;
};
/// The least-squares solution of Z2 x2 = Z1 R x1 + t (D. Zhu, equation 6) for both depths. Its equation 7 eliminates Z2
/// instead. x = (u, v, 1) on the normalized plane z = 1, (R, t) = `T_2_1`. The depths may be negative. Empty if the
/// rays are parallel.
std::optional<PairDepths> TriangulatePair(const Eigen::Vector2d& x1, const Eigen::Vector2d& x2, const SE3& T_2_1);

/// One observation of a point.
struct View {
  SE3 T_cam_world;
  Eigen::Vector2d x;  ///< on the normalized plane z = 1
};

struct TriangulatedPoint {
  Eigen::Vector3d position_world;
  Eigen::Matrix3d covariance;  ///< per unit variance of the observations on the plane z = 1
};

/// Triangulates a point from two or more views: the point nearest to all rays, then Gauss-Newton on the reprojection
/// error. Empty if the rays do not determine the point or it lies behind one of the cameras.
std::optional<TriangulatedPoint> TriangulateViews(std::span<const View> views);

}  // namespace evo::geometry
