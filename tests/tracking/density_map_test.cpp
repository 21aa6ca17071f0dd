#include "tracking/patch/density_map.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

namespace evo::tracking {
namespace {

TEST(DensityMap, VotesAreBilinearAndLoseNothingInside) {
  DensityMap map(5, 2);
  map.Vote(0.25f, -1.5f, 1, 2.0f);
  EXPECT_FLOAT_EQ(static_cast<float>(map.Total()), 2.0f);
  const float* plane = map.plane(1);
  const auto cell = [&](int x, int y) { return plane[(y + 5) * map.side() + x + 5]; };
  EXPECT_FLOAT_EQ(cell(0, -2), 2.0f * 0.75f * 0.5f);
  EXPECT_FLOAT_EQ(cell(1, -1), 2.0f * 0.25f * 0.5f);
  map.Vote(5.5f, 0.0f, 0, 1.0f);
  for (const float far : {std::nanf(""), INFINITY, -INFINITY, 1e10f, -1e10f}) {
    map.Vote(far, 0.0f, 0, 1.0f);
    map.Vote(0.0f, far, 0, 1.0f);
  }
  EXPECT_FLOAT_EQ(static_cast<float>(map.Total()), 2.0f);
}

TEST(DensityMap, ManyVoteLikeOneByOne) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-7.0f, 7.0f);
  std::vector<float> x, y;
  std::vector<std::int8_t> polarity;
  for (int i = 0; i < 83; ++i) {
    x.push_back(place(random));
    y.push_back(place(random));
    polarity.push_back(i % 3 ? 1 : -1);
  }
  for (const float far : {std::nanf(""), INFINITY, -INFINITY, 1e10f, -1e10f, 5.0f, -5.0f}) {
    x.insert(x.end(), {far, 0.0f});
    y.insert(y.end(), {0.0f, far});
    polarity.insert(polarity.end(), {1, -1});
  }
  for (const int planes : {1, 2}) {
    DensityMap together(5, planes), apart(5, planes);
    together.Vote(x, y, polarity);
    for (std::size_t i = 0; i < x.size(); ++i) apart.Vote(x[i], y[i], apart.PlaneOf(polarity[i]), 1.0f);
    EXPECT_GT(apart.Total(), 30.0);
    for (int i = 0; i < planes * apart.side() * apart.side(); ++i) {
      EXPECT_NEAR(together.plane(0)[i], apart.plane(0)[i], 1e-5) << i;
    }
  }
}

TEST(DensityMap, TotalIsTheSumOfTheCells) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> place(-6.0f, 6.0f);
  const auto random_map = [&] {
    DensityMap map(5, 2);
    for (int i = 0; i < 20; ++i) map.Vote(place(random), place(random), i % 2, 0.1f * static_cast<float>(i));
    std::vector<float> x, y;
    for (int i = 0; i < 61; ++i) {
      x.push_back(place(random));
      y.push_back(place(random));
    }
    map.Vote(x, y, std::vector<std::int8_t>(x.size(), 1));
    return map;
  };
  const auto expect_sum = [](const DensityMap& map) {
    double sum = 0.0;
    for (int p = 0; p < 2; ++p) sum = std::accumulate(map.plane(p), map.plane(p) + map.side() * map.side(), sum);
    EXPECT_NEAR(map.Total(), sum, 1e-4 * sum);
  };
  DensityMap map = random_map();
  expect_sum(map);
  map.Scale(0.3f);
  expect_sum(map);
  map.Blend(0.8f, random_map(), 0.1f);
  expect_sum(map);
  expect_sum(map.Warped(Eigen::Rotation2Dd(0.4).toRotationMatrix()));
  map.Clear();
  EXPECT_EQ(map.Total(), 0.0);
}

TEST(DensityMap, WarpMovesCellsAndKeepsTheNumberOfEvents) {
  DensityMap map(12, 1);
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) map.Vote(4.0f + 0.5f * i, 2.0f + 0.5f * j, 0, 1.0f);
  }
  Eigen::Matrix2d linear;
  linear << 1.5, 0.0, 0.0, 1.5;
  const DensityMap warped = map.Warped(linear);
  EXPECT_NEAR(warped.Total(), map.Total(), 0.05 * map.Total());
  double x = 0, y = 0;
  for (int r = 0; r < warped.side(); ++r) {
    for (int c = 0; c < warped.side(); ++c) {
      x += warped.plane(0)[r * warped.side() + c] * (c - 12);
      y += warped.plane(0)[r * warped.side() + c] * (r - 12);
    }
  }
  EXPECT_NEAR(x / warped.Total(), 6.0, 0.1);
  EXPECT_NEAR(y / warped.Total(), 3.0, 0.1);
}

TEST(DensityMap, WarpFollowsThePerspective) {
  DensityMap map(12, 1);
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) map.Vote(4.0f + 0.5f * i, -6.0f + 0.5f * j, 0, 1.0f);
  }
  const Eigen::Vector2d perspective(0.02, -0.03);
  const DensityMap warped = map.Warped(Eigen::Matrix2d::Identity(), perspective);
  const Eigen::Vector2d expected = Eigen::Vector2d(4, -6) / (1.0 + perspective.dot(Eigen::Vector2d(4, -6)));
  double x = 0, y = 0;
  for (int r = 0; r < warped.side(); ++r) {
    for (int c = 0; c < warped.side(); ++c) {
      x += warped.plane(0)[r * warped.side() + c] * (c - 12) / warped.Total();
      y += warped.plane(0)[r * warped.side() + c] * (r - 12) / warped.Total();
    }
  }
  EXPECT_NEAR(x, expected.x(), 0.15);
  EXPECT_NEAR(y, expected.y(), 0.15);
}

TEST(DensityMap, EffectiveCellsCountsHowFarEventsSpread) {
  DensityMap map(6, 1);
  for (int i = 0; i < 100; ++i) map.Vote(0.0f, 0.0f, 0, 1.0f);
  EXPECT_NEAR(map.EffectiveCells(), 1.0, 1e-6);
  map.Clear();
  for (int i = -4; i < 4; ++i) map.Vote(static_cast<float>(i), 0.0f, 0, 1.0f);
  EXPECT_NEAR(map.EffectiveCells(), 8.0, 1e-5);
}

TEST(AssociationField, MeanShiftOfOnePointLeadsBackToIt) {
  // The density of a single point p is N(u; p, sigma^2): its mean shift is exactly p - u.
  DensityMap map(15, 1);
  map.Vote(2.0f, -3.0f, 0, 100.0f);
  AssociationField field;
  field.Build(map, 2.0, 0.01);
  for (const auto& [x, y] : {std::pair{3.0f, -3.0f}, {1.0f, -1.0f}, {2.5f, -4.5f}}) {
    const auto pull = field.At(x, y, 0);
    ASSERT_GT(pull[0], 0.5f);
    EXPECT_NEAR(pull[1] / pull[0], 2.0f - x, 0.25f);
    EXPECT_NEAR(pull[2] / pull[0], -3.0f - y, 0.25f);
  }
  EXPECT_LT(field.At(-12.0f, 12.0f, 0)[0], 0.01f);
  for (const float far : {40.0f, INFINITY, -INFINITY, 1e10f, std::nanf("")}) {
    EXPECT_EQ(field.At(far, 0.0f, 0)[0], 0.0f);
    EXPECT_EQ(field.At(0.0f, far, 0)[0], 0.0f);
  }
}

TEST(AssociationField, WeighsTheCentreMost) {
  DensityMap map(12, 1);
  for (int x = -11; x <= 11; ++x) map.Vote(static_cast<float>(x), 0.0f, 0, 1.0f);
  AssociationField field;
  field.Build(map, 1.0, 0.0);
  EXPECT_FLOAT_EQ(field.At(0.0f, 0.0f, 0)[3], 1.0f);
  EXPECT_NEAR(field.At(6.0f, 0.0f, 0)[3], 0.75 * 0.75, 1e-5);
  EXPECT_NEAR(field.At(6.0f, 0.0f, 0)[0], 0.75 * 0.75, 1e-3);  // no stray events: the weight alone
  EXPECT_NEAR(field.At(11.9f, 0.0f, 0)[3], 0.0f, 0.005f);
}

TEST(AssociationField, OwnMomentsAreSumsOverThePatch) {
  DensityMap map(12, 2);
  for (int i = 0; i < 400; ++i) {
    const auto s = static_cast<float>(i);
    map.Vote(8.0f * std::sin(0.7f * s), 9.0f * std::cos(0.31f * s), i % 2, 1.0f);
  }
  AssociationField field;
  field.Build(map, 0.75, 0.2);
  Eigen::Matrix2d linear;
  for (const double turn : {0.0, 0.3, -0.1}) {
    linear << 1.13, turn, -turn, 0.91;
    Eigen::Matrix<double, 2, 3> sums = Eigen::Matrix<double, 2, 3>::Zero();
    double weight = 0.0;
    for (int p = 0; p < 2; ++p) {
      for (int v = -12; v <= 12; ++v) {
        for (int u = -12; u <= 12; ++u) {
          if ((linear * Eigen::Vector2d(u, v)).cwiseAbs().maxCoeff() > 8.0) continue;
          const double votes = map.plane(p)[(v + 12) * map.side() + u + 12];
          const auto pull = field.At(static_cast<float>(u), static_cast<float>(v), p);
          weight += votes * pull[0];
          sums += votes * Eigen::Vector2d(pull[1], pull[2]) * Eigen::RowVector3d(1.0, u, v);
        }
      }
    }
    EXPECT_LT((field.OwnMoments(map, linear, 8.0) - sums / weight).norm(), 1e-4) << turn;
  }
}

TEST(AssociationField, EvenWeightsLeaveThePullAsItIs) {
  DensityMap map(12, 1);
  for (int i = 0; i < 50; ++i) map.Vote(6.0f, 5.0f, 0, 1.0f);
  AssociationField centred, even;
  centred.Build(map, 1.5, 0.2);
  even.Build(map, 1.5, 0.2, AssociationField::Weight::kEven);
  const auto pull = centred.At(7.0f, 5.0f, 0);
  EXPECT_GT(pull[0], 0.1f);
  EXPECT_LT((even.At(7.0f, 5.0f, 0) - pull / pull[3]).abs().maxCoeff(), 1e-5f);
  EXPECT_EQ(even.At(12.0f, 5.0f, 0)[3], 0.0f);  // at the edge nothing pulls
  even.Build(map, 1.5, 0.2);
  EXPECT_TRUE((even.At(7.0f, 5.0f, 0) == pull).all());  // weights follow what is asked for
}

TEST(AssociationField, InformationIsThatOfABlurredLine) {
  DensityMap map(12, 1);
  for (float x = -11.0f; x <= 11.0f; x += 0.25f) {
    for (float y = -4.0f; y <= 4.0f; y += 0.1f) map.Vote(x, y, 0, std::exp(-0.5f * y * y));
  }
  AssociationField field;
  field.Build(map, 1.0, 1e-6);
  // Across the line, events of variance 1 + 1/6 (of the cells) in a density of 1 px^2 more; slopes are differences
  // over two cells.
  const double events = 1.0 + 1.0 / 6.0;
  double expected = 0.0, total = 0.0;
  for (int y = -8; y <= 8; ++y) {
    const auto density = [&](int at) { return std::exp(-0.5 * at * at / (events + 1.0)); };
    const double weight = std::exp(-0.5 * y * y / events);
    const double slope = 0.5 * (density(y + 1) - density(y - 1)) / density(y);
    expected += weight * slope * slope;
    total += weight;
  }
  const Eigen::Matrix2d information = field.Information(map, field);
  EXPECT_NEAR(information(1, 1), expected / total, 0.03);
  EXPECT_NEAR(information(0, 0), 0.0, 0.01);  // it may slide along itself
  EXPECT_NEAR(information(0, 1), 0.0, 1e-3);
}

TEST(AssociationField, NoiseInOneOfTwoDensitiesIsNoInformation) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> along(-10.0f, 10.0f);
  std::normal_distribution<float> across(0.0f, 0.5f);
  Eigen::Matrix2d own = Eigen::Matrix2d::Zero(), shared = Eigen::Matrix2d::Zero();
  constexpr int kTrials = 50;
  for (int trial = 0; trial < kTrials; ++trial) {  // a line, of which each half of the events knows some points
    DensityMap all(12, 1), halves[2] = {DensityMap(12, 1), DensityMap(12, 1)};
    for (int i = 0; i < 60; ++i) {
      const float x = along(random), y = across(random);
      all.Vote(x, y, 0, 1.0f);
      halves[i % 2].Vote(x, y, 0, 1.0f);
    }
    AssociationField field, fields[2];
    field.Build(all, 1.0, 0.2);
    for (int i = 0; i < 2; ++i) fields[i].Build(halves[i], 1.0, 0.2);
    own += field.Information(all, field) / kTrials;
    shared += fields[0].Information(all, fields[1]) / kTrials;
  }
  EXPECT_GT(own(0, 0), 0.02) << "clumps of the noise";
  EXPECT_LT(std::abs(shared(0, 0)), 0.35 * own(0, 0));
  EXPECT_GT(shared(1, 1), 0.5 * own(1, 1)) << "the line itself";
}

TEST(AssociationField, KeepsPolaritiesApart) {
  DensityMap map(10, 2);
  map.Vote(0.0f, 0.0f, map.PlaneOf(1), 10.0f);
  map.Vote(4.0f, 0.0f, map.PlaneOf(-1), 10.0f);
  AssociationField field;
  field.Build(map, 1.0, 0.1);
  EXPECT_LT(field.At(1.0f, 0.0f, map.PlaneOf(1))[1], 0.0f);
  EXPECT_GT(field.At(3.0f, 0.0f, map.PlaneOf(-1))[1], 0.0f);
}

}  // namespace
}  // namespace evo::tracking
