#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "evo/geometry/se3.hpp"

namespace evo::geometry {

/// The depths (z coordinates) of one point in two views, from Z2 x2 = Z1 R x1 + t (the paper's equation 6) in the
/// least-squares sense. Homogeneous x = (u, v, 1) on the plane z = 1; `T_2_1` takes coordinates in camera 1 to camera
/// 2. The depths may be negative. Empty where the rays are parallel.
struct PairDepths {
  double z1 = 0.0;
  double z2 = 0.0;
};
std::optional<PairDepths> TriangulatePair(const Eigen::Vector2d& x1, const Eigen::Vector2d& x2, const SE3& T_2_1);

/// One sighting of a point: the camera's pose and where on its plane z = 1 the point was seen.
struct View {
  SE3 T_cam_world;
  Eigen::Vector2d x;
};

struct TriangulatedPoint {
  Eigen::Vector3d position_world;
  Eigen::Matrix3d covariance;  ///< for a noise of one unit on the plane z = 1: multiply by the noise's variance
  double parallax = 0.0;       ///< rad, the largest angle between the first ray and any other
};

/// A point from two or more views: the point nearest to all rays, then Gauss-Newton on the reprojection error.
/// Empty where the rays do not fix the point or it ends behind one of the cameras.
std::optional<TriangulatedPoint> TriangulateViews(std::span<const View> views);

}  // namespace evo::geometry
