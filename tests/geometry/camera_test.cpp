#include "evo/geometry/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "evo/geometry/known_cameras.hpp"

namespace evo::geometry {
namespace {

TEST(Camera, UndistortInvertsDistortOnTheWholeSensor) {
  for (const auto& calibration : {MvsecDavis346(), UzhDavis240c()}) {
    const Camera camera(calibration);
    for (int y = 0; y < camera.height(); y += 7) {
      for (int x = 0; x < camera.width(); x += 7) {
        const auto ray = camera.Undistort({x, y});
        ASSERT_TRUE(ray) << x << " " << y;
        EXPECT_LT((camera.Distort(*ray) - Eigen::Vector2d(x, y)).norm(), 1e-6) << x << " " << y;
      }
    }
  }
}

TEST(Camera, EquidistantIsKannalaBrandt) {
  const Camera camera(MvsecDavis346());
  const double theta = 0.5;
  const auto& k = camera.calibration().coefficients;
  const double radius = theta + k[0] * std::pow(theta, 3) + k[1] * std::pow(theta, 5) + k[2] * std::pow(theta, 7) +
                        k[3] * std::pow(theta, 9);
  const Eigen::Vector2d pixel = camera.Project({std::sin(theta), 0, std::cos(theta)});
  EXPECT_NEAR(pixel.x(), camera.calibration().fx * radius + camera.calibration().cx, 1e-9);
  EXPECT_NEAR(pixel.y(), camera.calibration().cy, 1e-9);
}

TEST(Camera, RadTanIsBrownConrady) {
  const Camera camera(UzhDavis240c());
  const auto& k = camera.calibration().coefficients;
  const double x = 0.3, y = -0.2, r2 = x * x + y * y;
  const double radial = 1 + k[0] * r2 + k[1] * r2 * r2;
  const double xd = x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x);
  const double yd = y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y;
  const Eigen::Vector2d pixel = camera.Distort({x, y});
  EXPECT_NEAR(pixel.x(), camera.calibration().fx * xd + camera.calibration().cx, 1e-9);
  EXPECT_NEAR(pixel.y(), camera.calibration().fy * yd + camera.calibration().cy, 1e-9);
}

TEST(Camera, RejectsPixelsWithoutARay) {
  Calibration strong = UzhDavis240c();
  strong.coefficients = {-0.8, 0, 0, 0, 0};
  EXPECT_FALSE(Camera(strong).Undistort({5000, 5000}));
  EXPECT_FALSE(Camera(MvsecDavis346()).Undistort({5000, 5000}));
}

TEST(Camera, ContainsCountsPixelCentres) {
  const Camera camera(UzhDavis240c());
  EXPECT_TRUE(camera.Contains({0, 0}));
  EXPECT_TRUE(camera.Contains({239, 179}));
  EXPECT_FALSE(camera.Contains({239.5, 10}));
  EXPECT_FALSE(camera.Contains({2, 10}, 3));
}

}  // namespace
}  // namespace evo::geometry
