#include "evo/geometry/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace evo {
namespace {

Calibration Davis346() {  // MVSEC outdoor_day, left
  return {Distortion::kEquidistant,
          346,
          260,
          223.9940010790056,
          223.61783486959376,
          170.7684322973841,
          128.18711828338436,
          {-0.033904378348448685, -0.01537260902537579, -0.022284741346941413, 0.0069204143687187645, 0}};
}

Calibration Davis240() {  // UZH boxes_6dof
  return {Distortion::kRadTan,
          240,
          180,
          199.092366542,
          198.82882047,
          132.192071378,
          110.712660011,
          {-0.368436311798, 0.150947243557, -0.000296130534385, -0.000759431726241, 0.0}};
}

TEST(Camera, UndistortUndoesDistortOverTheWholeSensor) {
  for (const auto& calibration : {Davis346(), Davis240()}) {
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

TEST(Camera, EquidistantFollowsKannalaBrandt) {
  const Camera camera(Davis346());
  const double theta = 0.5;
  const auto& k = camera.calibration().coefficients;
  const double radius = theta + k[0] * std::pow(theta, 3) + k[1] * std::pow(theta, 5) + k[2] * std::pow(theta, 7) +
                        k[3] * std::pow(theta, 9);
  const Eigen::Vector2d pixel = camera.Project({std::sin(theta), 0, std::cos(theta)});
  EXPECT_NEAR(pixel.x(), camera.calibration().fx * radius + camera.calibration().cx, 1e-9);
  EXPECT_NEAR(pixel.y(), camera.calibration().cy, 1e-9);
}

TEST(Camera, RadTanFollowsBrownConrady) {
  const Camera camera(Davis240());
  const auto& k = camera.calibration().coefficients;
  const double x = 0.3, y = -0.2, r2 = x * x + y * y;
  const double radial = 1 + k[0] * r2 + k[1] * r2 * r2;
  const double xd = x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x);
  const double yd = y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y;
  const Eigen::Vector2d pixel = camera.Distort({x, y});
  EXPECT_NEAR(pixel.x(), camera.calibration().fx * xd + camera.calibration().cx, 1e-9);
  EXPECT_NEAR(pixel.y(), camera.calibration().fy * yd + camera.calibration().cy, 1e-9);
}

TEST(Camera, RefusesPixelsThatNoRayReaches) {
  Calibration strong = Davis240();
  strong.coefficients = {-0.8, 0, 0, 0, 0};
  EXPECT_FALSE(Camera(strong).Undistort({5000, 5000}));
  EXPECT_FALSE(Camera(Davis346()).Undistort({5000, 5000}));
}

TEST(Camera, ContainsCountsPixelCentres) {
  const Camera camera(Davis240());
  EXPECT_TRUE(camera.Contains({0, 0}));
  EXPECT_TRUE(camera.Contains({239, 179}));
  EXPECT_FALSE(camera.Contains({239.5, 10}));
  EXPECT_FALSE(camera.Contains({2, 10}, 3));
}

}  // namespace
}  // namespace evo
