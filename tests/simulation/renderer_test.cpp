#include "simulation/render/renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "evo/core/error.hpp"
#include "simulation/render_scene.hpp"

namespace evo::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

class RendererWith : public testing::TestWithParam<geometry::Distortion> {
 protected:
  geometry::Camera camera() const { return GetParam() == geometry::Distortion::kRadTan ? Davis240() : Davis346(); }
};
INSTANTIATE_TEST_SUITE_P(BothLenses, RendererWith,
                         testing::Values(geometry::Distortion::kRadTan, geometry::Distortion::kEquidistant));

TEST_P(RendererWith, DepthOfAPlaneIsExact) {
  const geometry::Camera lens = camera();
  Scene scene = Empty();
  scene.surfaces.push_back(LevelGround());
  const auto depth = DepthOfAll(scene, lens);
  int seen = 0;
  for (int y = 0; y < lens.height(); ++y) {
    for (int x = 0; x < lens.width(); ++x) {
      const double down = lens.Undistort({x, y})->y();
      const double z = 1.5 / down;
      const float found = depth[y * lens.width() + x];
      if (down <= 0.0 || z > 390.0) {
        EXPECT_TRUE(std::isnan(found)) << x << " " << y;
      } else if (z < 100.0) {
        EXPECT_NEAR(found, z, 1e-5 * z) << x << " " << y;
        ++seen;
      }
    }
  }
  EXPECT_GT(seen, lens.width() * lens.height() / 3);
}

TEST_P(RendererWith, AgreesWithOneRayAtATime) {
  const geometry::Camera lens = camera();
  for (int seed = 0; seed < 4; ++seed) {
    const Scene scene = RandomScene(60, seed);
    const TimeNs t = FromSeconds(0.3);
    const geometry::SE3 pose(geometry::so3::Exp({0.1, -0.3, 0.2}), {0.5, 1.0, -0.7});
    const auto depth = DepthOfAll(scene, lens, t, pose);
    for (int i = 0; i < lens.width() * lens.height(); i += 37) {
      const auto ray = *lens.Undistort({i % lens.width(), i / lens.width()});
      const Hit hit = CastRay(scene, ray, t, pose);
      if (hit.margin < 1e-4) continue;
      if (hit.surface < 0) {
        EXPECT_TRUE(std::isnan(depth[i])) << i;
      } else {
        EXPECT_NEAR(depth[i], hit.depth, 1e-4 * hit.depth) << i;
      }
    }
  }
}

/// Position of the edge from bright to dark along a line of pixels: the bright ones' count from the first.
double EdgeAt(const std::vector<double>& line, double bright, double dark) {
  double sum = 0.0;
  for (const double value : line) sum += (value - dark) / (bright - dark);
  return sum - 0.5;
}

TEST_P(RendererWith, CornersAreWhereTheCameraProjectsThem) {
  const geometry::Camera lens = camera();
  for (const int samples : {2, 8}) {
    double mean_error = 0.0;
    for (int i = 0; i < 12; ++i) {
      // The lower right corner of a bright square in the dark, near place i of the image.
      const Vector2d near(50.3 + 40.17 * (i % 4), 40.6 + 45.29 * (i / 4));
      const Vector3d corner = 5.0 * lens.Undistort(near)->homogeneous();
      Scene scene = Empty();
      scene.lighting.sky = 0.0;
      scene.surfaces.push_back(Facing(corner.x() - 4, corner.x(), corner.y() - 4, corner.y(), corner.z()));
      const auto image = RenderAll(scene, lens, samples);
      // Its two edges, found 6 to 14 px from the corner along the row (column) and led to the corner along straight
      // lines of the scene, which the lens bends: each found place is compared with the projected edge.
      double error_x = 0.0;
      double error_y = 0.0;
      for (int away = 6; away <= 14; ++away) {
        const int row = static_cast<int>(near.y()) - away;
        const int column = static_cast<int>(near.x()) - away;
        std::vector<double> along_row;
        std::vector<double> along_column;
        for (int k = -10; k <= 10; ++k) {
          along_row.push_back(image[row * lens.width() + static_cast<int>(near.x()) + k]);
          along_column.push_back(image[(static_cast<int>(near.y()) + k) * lens.width() + column]);
        }
        double edge_x = near.x();  // of the scene's edge x = corner.x on that row
        double edge_y = near.y();
        for (int pass = 0; pass < 5; ++pass) {
          const double y = lens.Undistort({edge_x, row})->y();
          edge_x = lens.Distort({corner.x() / corner.z(), y}).x();
          const double x = lens.Undistort({column, edge_y})->x();
          edge_y = lens.Distort({x, corner.y() / corner.z()}).y();
        }
        error_x += (EdgeAt(along_row, 0.5, 0.0) + static_cast<int>(near.x()) - 10 - edge_x) / 9.0;
        error_y += (EdgeAt(along_column, 0.5, 0.0) + static_cast<int>(near.y()) - 10 - edge_y) / 9.0;
      }
      mean_error += std::hypot(error_x, error_y) / 12.0;
      EXPECT_LT(std::hypot(error_x, error_y), samples == 2 ? 0.1 : 0.03) << near.transpose() << " " << samples;
      EXPECT_LT((lens.Project(corner) - near).norm(), 1e-6);
    }
    EXPECT_LT(mean_error, samples == 2 ? 0.04 : 0.006);
  }
}

TEST_P(RendererWith, DoesNotDependOnTheTiles) {
  const geometry::Camera lens = camera();
  const Scene scene = RandomScene(40, 9);
  const auto whole = RenderAll(scene, lens, 2);
  const Renderer renderer(scene, lens, 2);
  for (const Tile& tile : CutIntoTiles(lens.width(), lens.height(), 21)) {
    Renderer::Radiance part;
    const auto visible = renderer.FindVisible(tile, 0, 0, geometry::SE3(), geometry::SE3());
    renderer.Render(tile, visible, 0, geometry::SE3(), &part);
    for (int i = 0; i < tile.width * tile.height; ++i) {
      const int x = tile.x0 + i % tile.width;
      const int y = tile.y0 + i / tile.width;
      ASSERT_NEAR(part.steady[i], whole[y * lens.width() + x], 1e-5) << x << " " << y;
    }
  }
}

TEST(Renderer, AFarCheckerboardFadesToItsMean) {
  std::vector<Texel> checks(64 * 64);
  for (int i = 0; i < 64 * 64; ++i) checks[i].reflectance = (i % 64 / 4 + i / 64 / 4) % 2 ? 0.9F : 0.1F;
  Scene scene = Empty();
  scene.textures.push_back(Texture(64, 64, checks));
  for (const double tilt : {0.0, 0.6, 1.2}) {
    Surface board = Facing(-200, 200, 0, 0, 40, 1);
    board.edge_v = 400.0 * Vector3d(0, std::cos(tilt), std::sin(tilt));
    board.origin -= 0.2 * board.edge_v;
    board.texels = {400 * 64, 400 * 64};  // checks of 1/16 m; a pixel is 18 cm wide
    scene.surfaces = {board};
    const auto image = RenderAll(scene, Davis346(), 2);
    double mean = 0.0;
    double most = 0.0;
    for (int y = 100; y < 160; ++y) {
      for (int x = 140; x < 200; ++x) {
        mean += image[y * 346 + x] / 3600.0;
        most = std::max(most, std::abs(image[y * 346 + x] - 0.5));
      }
    }
    EXPECT_NEAR(mean, 0.5, 0.005) << tilt;
    EXPECT_LT(most, 0.12) << tilt;
  }
}

TEST(Renderer, TexturesFollowTheirCoordinates) {
  std::vector<Texel> half(2, {.reflectance = 0.2F});
  half[1].reflectance = 0.8F;
  Scene scene = Empty();
  scene.textures.push_back(Texture(2, 1, half));
  Surface wall = Facing(-1, 1, -1, 1, 2, 1);
  wall.texel_origin = {1000.0, 0.0};  // an even number: texel 0 is left
  wall.texels = {2.0, 1.0};
  scene.surfaces = {wall};
  const geometry::Camera lens = Davis346();
  const auto image = RenderAll(scene, lens, 2);
  const auto at = [&](double x) {
    const Vector2d pixel = lens.Project({x, 0.0, 2.0});
    return image[static_cast<int>(pixel.y() + 0.5) * 346 + static_cast<int>(pixel.x() + 0.5)];
  };
  EXPECT_NEAR(at(-0.5), 0.2, 0.01);
  EXPECT_NEAR(at(0.5), 0.8, 0.01);
  EXPECT_NEAR(at(0.0), 0.5, 0.01);
}

TEST(Renderer, HolesAreCompositedFromFrontToBack) {
  Scene scene = Empty();
  scene.textures.push_back(Plain(0.8F, 0.25F));
  scene.textures.push_back(Plain(0.1F, 0.6F));
  scene.textures.push_back(Plain(0.9F, 0.0F));
  scene.surfaces = {Facing(-9, 9, -9, 9, 5, 2), Facing(-9, 9, -9, 9, 3, 1), Facing(-9, 9, -9, 9, 2, 3)};
  scene.lighting.sky = 2.0;
  const double expected = 0.25 * 0.8 + 0.75 * (0.6 * 0.1 + 0.4 * 2.0);
  const geometry::Camera lens = Davis346();
  EXPECT_NEAR(RenderAll(scene, lens, 2)[130 * 346 + 170], expected, 1e-5);
  EXPECT_NEAR(DepthOfAll(scene, lens)[130 * 346 + 170], 5.0, 1e-5) << "the first that covers half";
}

TEST(Renderer, BodiesMove) {
  Scene scene = Empty();
  scene.bodies.push_back({.T_world_body = [](TimeNs t) { return geometry::SE3({1, 0, 0, 0}, {ToSeconds(t), 0, 0}); }});
  scene.surfaces.push_back(Facing(-1, 0, -9, 9, 4));
  scene.surfaces[0].body = 1;
  scene.lighting.sky = 0.0;
  const geometry::Camera lens = Davis240();
  for (const double t : {0.0, 0.1, 0.77}) {
    const auto image = RenderAll(scene, lens, 4, FromSeconds(t));
    const int row = 110;  // near the centre: straight edges stay straight
    const double sum = std::accumulate(image.begin() + row * 240, image.begin() + (row + 1) * 240, 0.0) / 0.5;
    const double width = lens.Project({t, 0, 4}).x() - lens.Project({t - 1, 0, 4}).x();
    EXPECT_NEAR(sum, width, 0.15) << t;
    EXPECT_GT(image[row * 240 + static_cast<int>(lens.Project({t - 0.1, 0, 4}).x())], 0.4) << t;
    EXPECT_EQ(image[row * 240 + static_cast<int>(lens.Project({t + 0.1, 0, 4}).x())], 0.0F) << t;
  }
}

/// The radiance that `scene` shows at the pixel nearest to a point, and the ray of that pixel's centre.
std::pair<double, Vector3d> SeenNear(const Scene& scene, const Vector3d& point, TimeNs t) {
  const geometry::Camera lens = Davis346();
  const Vector2d pixel = lens.Project(point).array().round();
  const auto image = RenderAll(scene, lens, 4, t);
  return {image[static_cast<int>(pixel.y()) * 346 + static_cast<int>(pixel.x())], lens.Undistort(pixel)->homogeneous()};
}

TEST(Renderer, StreetLampsFollowTheirClosedForm) {
  Scene scene = Empty();
  Surface ground;
  ground.origin = {-50, 1.5, -10};
  ground.edge_u = {100, 0, 0};
  ground.edge_v = {0, 0, 100};
  scene.surfaces = {ground};
  scene.lighting.ambient = 0.01;
  scene.lighting.lamps = {{{2.0, -4.0, 9.0}, 8.0}, {{-3.0, 2.5, 8.0}, 100.0}};  // the second one below the ground
  const TimeNs t = FromSeconds(0.0011);
  const auto [radiance, ray] = SeenNear(scene, {1.0, 1.5, 8.0}, t);
  const Vector3d place = ray * (1.5 / ray.y());
  const double distance = (place - scene.lighting.lamps[0].position).norm();
  const double flicker = 1.0 + 0.5 * std::sin(2.0 * std::numbers::pi * 120.0 * 0.0011);
  const double expected = 0.5 * (0.01 + 8.0 * flicker * 5.5 / std::pow(distance, 3));
  EXPECT_NEAR(radiance, expected, 2e-3 * expected);
}

TEST(Renderer, HeadLampsMoveWithTheCamera) {
  Scene scene = Empty();
  scene.surfaces = {Facing(-50, 50, -50, 50, 10)};
  scene.surfaces[0].emission = 0.003F;
  scene.lighting.ambient = 0.0;
  scene.lighting.head_lamps = 40.0;
  for (const Vector3d& point : {Vector3d(0, 0, 10), Vector3d(2, 1, 10)}) {
    const auto [radiance, ray] = SeenNear(scene, point, 0);
    const double beam = std::pow(1.0 + std::pow(ray.x() / 0.35, 2) + std::pow(ray.y() / 0.15, 2), -2);
    const double distance = 10.0 * ray.norm();
    const double expected = 0.5 * 40.0 * beam * (10.0 / distance) / (distance * distance) + 0.003;
    EXPECT_NEAR(radiance, expected, 5e-3 * expected);
  }
}

TEST(Renderer, APixelWithoutARayIsBlack) {
  geometry::Calibration folded = Davis240().calibration();
  folded.coefficients = {-0.9, 0.0, 0.0, 0.0, 0.0};  // folds back inside the sensor
  const geometry::Camera lens(folded);
  ASSERT_FALSE(lens.Undistort({0, 0}));
  Scene scene = Empty();
  EXPECT_EQ(RenderAll(scene, lens, 2)[0], 0.0F);
  EXPECT_EQ(RenderAll(scene, lens, 2)[110 * 240 + 132], 2.0F);
  scene.surfaces.push_back(Facing(-99, 99, -99, 99, 3));
  EXPECT_TRUE(std::isnan(DepthOfAll(scene, lens)[0]));
  EXPECT_NEAR(DepthOfAll(scene, lens)[110 * 240 + 132], 3.0, 1e-5);
}

TEST(Renderer, RejectsBadSamplesAndBadSurfaces) {
  const geometry::Camera lens = Davis240();
  Scene scene = Empty();
  EXPECT_THROW(Renderer(scene, lens, 0), Error);
  EXPECT_THROW(Renderer(scene, lens, 17), Error);
  scene.surfaces.push_back(Facing(-1, 1, -1, 1, 3, 1));
  EXPECT_THROW(Renderer(scene, lens, 2), Error) << "no such texture";
  scene.surfaces[0].texture = 0;
  scene.surfaces[0].body = 1;
  EXPECT_THROW(Renderer(scene, lens, 2), Error) << "no such body";
}

TEST(Renderer, TilesCoverTheSensorOnce) {
  std::vector<int> count(346 * 260);
  for (const Tile& tile : CutIntoTiles(346, 260, 16)) {
    for (int y = tile.y0; y < tile.y0 + tile.height; ++y) {
      for (int x = tile.x0; x < tile.x0 + tile.width; ++x) ++count.at(y * 346 + x);
    }
  }
  EXPECT_EQ(std::count(count.begin(), count.end(), 1), 346 * 260);
}

}  // namespace
}  // namespace evo::simulation
