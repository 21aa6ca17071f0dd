#include "evo/geometry/se3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace evo::geometry {
namespace {

Vector6d RandomTwist(std::mt19937* random, double angle) {
  std::normal_distribution<double> normal;
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = normal(*random);
  xi.tail<3>() *= angle / xi.tail<3>().norm();
  return xi;
}

TEST(SE3, LogInvertsExpAtEveryAngle) {
  std::mt19937 random(1);
  for (const double angle : {1e-12, 1e-7, 1e-5, 1e-3, 0.5, 2.0, 3.1}) {
    const Vector6d xi = RandomTwist(&random, angle);
    EXPECT_LT((SE3::Exp(xi).Log() - xi).norm(), 1e-9) << angle;
  }
}

TEST(SE3, ComposesLikeMatrices) {
  std::mt19937 random(2);
  const SE3 a = SE3::Exp(RandomTwist(&random, 1.0));
  const SE3 b = SE3::Exp(RandomTwist(&random, 2.0));
  EXPECT_LT(((a * b).Matrix() - a.Matrix() * b.Matrix()).norm(), 1e-12);
  EXPECT_LT(((a * a.Inverse()).Matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-12);
}

TEST(SE3, ExpIsTheMatrixExponential) {
  std::mt19937 random(3);
  const Vector6d xi = RandomTwist(&random, 0.7);
  Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
  generator.topLeftCorner<3, 3>() = so3::Hat(xi.tail<3>());
  generator.topRightCorner<3, 1>() = xi.head<3>();
  Eigen::Matrix4d sum = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity();
  for (int n = 1; n < 40; ++n) {
    term = term * generator / n;
    sum += term;
  }
  EXPECT_LT((SE3::Exp(xi).Matrix() - sum).norm(), 1e-12);
}

TEST(SE3, LeftJacobianMatchesFiniteDifferences) {
  const Eigen::Vector3d phi(0.4, -0.9, 0.2);
  const Eigen::Matrix3d jacobian = so3::LeftJacobian(phi);
  for (int i = 0; i < 3; ++i) {
    const double h = 1e-6;
    const Eigen::Vector3d d = h * Eigen::Vector3d::Unit(i);
    const Eigen::Vector3d numeric = so3::Log(so3::Exp(phi + d) * so3::Exp(phi - d).conjugate()) / (2 * h);
    EXPECT_LT((jacobian.col(i) - numeric).norm(), 1e-8);
  }
}

TEST(SE3, AdjointTakesATwistAcrossAMotion) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 10; ++trial) {
    const SE3 T = SE3::Exp(RandomTwist(&random, 1.2));
    const Vector6d xi = RandomTwist(&random, 0.7);
    EXPECT_LT(((T * SE3::Exp(xi)).Matrix() - (SE3::Exp(Adjoint(T) * xi) * T).Matrix()).norm(), 1e-9) << trial;
  }
}

TEST(SE3, InterpolatesAlongTheShorterArc) {
  const SE3 a;
  const SE3 b(Eigen::Quaterniond(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ())), Eigen::Vector3d(2, 0, 0));
  const SE3 half = Interpolate(a, b, 0.5);
  EXPECT_NEAR(so3::Log(half.rotation()).z(), 0.5, 1e-12);
  EXPECT_NEAR(half.translation().x(), 1.0, 1e-12);
}

}  // namespace
}  // namespace evo::geometry
