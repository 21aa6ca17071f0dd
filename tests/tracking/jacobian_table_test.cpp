#include "tracking/motion/jacobian_table.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "evo/geometry/known_cameras.hpp"
#include "evo/geometry/se3.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

TEST(JacobianTable, JacobiansAgreeWithNumericOnes) {
  const geometry::Camera camera(geometry::MvsecDavis346());
  const JacobianTable jacobians(camera);
  constexpr double kStep = 1e-6;
  for (const Vector2d& pixel : {Vector2d(20, 240), Vector2d(172, 128), Vector2d(332, 12)}) {
    const PixelJacobians at = jacobians.Lookup(pixel);
    EXPECT_LT((camera.Distort(at.normalized) - pixel).norm(), 1e-6);
    for (int axis = 0; axis < 2; ++axis) {
      const Vector2d moved = camera.Distort(at.normalized + kStep * Vector2d::Unit(axis));
      EXPECT_LT(((moved - pixel) / kStep - at.J_pixel_normalized.col(axis)).norm(), 0.1);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d rotated = geometry::so3::Exp(kStep * Vector3d::Unit(axis)) * at.normalized.homogeneous();
      EXPECT_LT(((camera.Project(rotated) - pixel) / kStep - at.J_pixel_rotation.col(axis)).norm(), 0.1);
    }
  }
}

TEST(JacobianTable, ExtrapolatesBetweenItsPoints) {
  const geometry::Camera camera(geometry::MvsecDavis346());
  const JacobianTable jacobians(camera);
  for (const Vector2d& pixel : {Vector2d(21.7, 238.2), Vector2d(333.9, 10.1), Vector2d(100.5, 77.3)}) {
    EXPECT_LT((camera.Distort(jacobians.Lookup(pixel).normalized) - pixel).norm(), 0.1);
  }
}

}  // namespace
}  // namespace evo::tracking
