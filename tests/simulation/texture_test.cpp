#include "simulation/world/texture.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "evo/core/error.hpp"
#include "evo/core/random.hpp"

namespace evo::simulation {
namespace {

std::vector<Texel> Noise(int count, bool holes) {
  Random random(3);
  std::vector<Texel> texels(count);
  for (Texel& texel : texels) {
    texel.reflectance = static_cast<float>(random.Uniform(0.1, 0.9));
    if (holes) texel.coverage = random.Chance(0.4) ? 0.0F : 1.0F;
  }
  return texels;
}

TEST(Texture, InterpolatesBetweenTexelCentresAndRepeats) {
  const auto texels = Noise(8 * 4, false);
  const Texture texture(8, 4, texels);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) {
      const float expected = texels[y * 8 + x].reflectance;
      EXPECT_NEAR(texture.Lookup(x + 0.5, y + 0.5, 0.0).reflectance, expected, 1e-6);
      EXPECT_NEAR(texture.Lookup(x + 0.5 - 80.0, y + 0.5 + 40.0, 0.5).reflectance, expected, 1e-6);
    }
  }
  const float between =
      0.25F * (texels[0].reflectance + texels[1].reflectance + texels[8].reflectance + texels[9].reflectance);
  EXPECT_NEAR(texture.Lookup(1.0, 1.0, 0.0).reflectance, between, 1e-6);
}

TEST(Texture, AveragesOverItsFootprint) {
  const auto texels = Noise(64 * 64, false);
  const Texture texture(64, 64, texels);
  float mean = 0.0F;
  for (const Texel& texel : texels) mean += texel.reflectance / 4096.0F;
  EXPECT_NEAR(texture.Lookup(3.3, 60.1, 64.0).reflectance, mean, 1e-4);
  EXPECT_NEAR(texture.Lookup(3.3, 60.1, 1e6).reflectance, mean, 1e-4);
  float block = 0.0F;  // texels 8..11 by 20..23 are one of level 2
  for (int y = 20; y < 24; ++y) {
    for (int x = 8; x < 12; ++x) block += texels[y * 64 + x].reflectance / 16.0F;
  }
  EXPECT_NEAR(texture.Lookup(10.0, 22.0, 4.0).reflectance, block, 1e-5);
}

TEST(Texture, IsContinuousInPlaceAndFootprint) {
  const Texture texture(32, 16, Noise(32 * 16, true));
  Texel last = texture.Lookup(-3.0, 2.0, 0.1);
  for (int i = 1; i < 40'000; ++i) {
    const double s = i / 40'000.0;
    const Texel texel = texture.Lookup(-3.0 + 40.0 * s, 2.0 - 20.0 * s, 0.1 * std::pow(500.0, s));
    ASSERT_NEAR(texel.coverage, last.coverage, 0.02) << i;
    last = texel;
  }
}

TEST(Texture, HolesDoNotAffectTheirSurroundings) {
  std::vector<Texel> texels(16 * 16, {.reflectance = 0.9F, .coverage = 0.0F});
  for (int i = 0; i < 256; i += 2) texels[i] = {.reflectance = 0.2F, .coverage = 1.0F};
  const Texture texture(16, 16, texels);
  EXPECT_FALSE(texture.solid());
  for (const double footprint : {0.0, 1.3, 5.0, 100.0}) {
    const Texel texel = texture.Lookup(4.9, 7.2, footprint);
    EXPECT_NEAR(texel.reflectance, 0.2, 1e-5) << footprint;
    EXPECT_GT(texel.coverage, 0.0F);
  }
  EXPECT_NEAR(texture.Lookup(4.9, 7.2, 100.0).coverage, 0.5, 1e-6);
}

TEST(Texture, LessContrastKeepsTheMeanOnAllLevels) {
  Random random(4);
  std::vector<Texel> texels(16 * 16);
  for (Texel& texel : texels) texel = {static_cast<float>(random.Uniform(0.1, 0.9)), random.Chance(0.8) ? 1.0F : 0.0F};
  const Texture before(16, 16, texels);
  Texture after = before;
  after.ScaleContrast(0.25F);
  const float mean = before.Lookup(0.0, 0.0, 100.0).reflectance;
  for (const double footprint : {0.0, 1.7, 3.0, 100.0}) {
    for (int i = 0; i < 50; ++i) {
      const double u = random.Uniform(0.0, 16.0);
      const Texel a = before.Lookup(u, 2.0 * u, footprint), b = after.Lookup(u, 2.0 * u, footprint);
      EXPECT_EQ(a.coverage, b.coverage);
      if (a.coverage > 0.01F) {
        EXPECT_NEAR(b.reflectance - mean, 0.25F * (a.reflectance - mean), 1e-4F);
      }
    }
  }
}

TEST(Texture, LessCoverageKeepsTheReflectance) {
  const Texture solid(1, 1, {{.reflectance = 0.4F}});
  Texture sheer = solid;
  sheer.ScaleCoverage(0.7F);
  EXPECT_TRUE(solid.solid());
  EXPECT_FALSE(sheer.solid());
  EXPECT_NEAR(sheer.Lookup(0.3, 0.3, 0.0).coverage, 0.7, 1e-6);
  EXPECT_NEAR(sheer.Lookup(0.3, 0.3, 0.0).reflectance, 0.4, 1e-6);
}

TEST(Texture, RejectsSizesThatAreNoPowersOfTwo) {
  EXPECT_THROW(Texture(3, 4, std::vector<Texel>(12)), Error);
  EXPECT_THROW(Texture(4, 4, std::vector<Texel>(15)), Error);
  EXPECT_THROW(Texture(0, 4, {}), Error);
}

}  // namespace
}  // namespace evo::simulation
