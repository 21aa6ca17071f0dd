#include "tracking/patch/association_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "tracking/patch/event_histogram.hpp"

namespace evo::tracking {
namespace {

TEST(AssociationTable, MeanShiftOfOnePointIsTheWayToIt) {
  // The density of a single point p is N(u; p, sigma^2): its mean shift is exactly p - u.
  EventHistogram histogram(15, 1);
  histogram.Vote(2.0f, -3.0f, 0, 100.0f);
  AssociationTable table;
  table.Build(histogram, 2.0, 0.01);
  for (const auto& [x, y] : {std::pair{3.0f, -3.0f}, {1.0f, -1.0f}, {2.5f, -4.5f}}) {
    const auto association = table.Interpolate(x, y, 0);
    ASSERT_GT(association[0], 0.5f);
    EXPECT_NEAR(association[1] / association[0], 2.0f - x, 0.25f);
    EXPECT_NEAR(association[2] / association[0], -3.0f - y, 0.25f);
  }
  EXPECT_LT(table.Interpolate(-12.0f, 12.0f, 0)[0], 0.01f);
  for (const float far : {40.0f, INFINITY, -INFINITY, 1e10f, std::nanf("")}) {
    EXPECT_EQ(table.Interpolate(far, 0.0f, 0)[0], 0.0f);
    EXPECT_EQ(table.Interpolate(0.0f, far, 0)[0], 0.0f);
  }
}

TEST(AssociationTable, BiweightIsLargestAtTheCentre) {
  EventHistogram histogram(12, 1);
  for (int x = -11; x <= 11; ++x) histogram.Vote(static_cast<float>(x), 0.0f, 0, 1.0f);
  AssociationTable table;
  table.Build(histogram, 1.0, 0.0);
  EXPECT_FLOAT_EQ(table.Interpolate(0.0f, 0.0f, 0)[3], 1.0f);
  EXPECT_NEAR(table.Interpolate(6.0f, 0.0f, 0)[3], 0.75 * 0.75, 1e-5);
  EXPECT_NEAR(table.Interpolate(6.0f, 0.0f, 0)[0], 0.75 * 0.75, 1e-3);  // no outliers: the weight alone
  EXPECT_NEAR(table.Interpolate(11.9f, 0.0f, 0)[3], 0.0f, 0.005f);
}

TEST(AssociationTable, SelfBiasIsASumOverThePatch) {
  EventHistogram histogram(12, 2);
  for (int i = 0; i < 400; ++i) {
    const auto s = static_cast<float>(i);
    histogram.Vote(8.0f * std::sin(0.7f * s), 9.0f * std::cos(0.31f * s), i % 2, 1.0f);
  }
  AssociationTable table;
  table.Build(histogram, 0.75, 0.2);
  Eigen::Matrix2d linear;
  for (const double shear : {0.0, 0.3, -0.1}) {
    linear << 1.13, shear, -shear, 0.91;
    Eigen::Matrix<double, 2, 3> sums = Eigen::Matrix<double, 2, 3>::Zero();
    double weight = 0.0;
    for (int p = 0; p < 2; ++p) {
      for (int v = -12; v <= 12; ++v) {
        for (int u = -12; u <= 12; ++u) {
          if ((linear * Eigen::Vector2d(u, v)).cwiseAbs().maxCoeff() > 8.0) continue;
          const double votes = histogram.plane(p)[(v + 12) * histogram.side() + u + 12];
          const auto association = table.Interpolate(static_cast<float>(u), static_cast<float>(v), p);
          weight += votes * association[0];
          sums += votes * Eigen::Vector2d(association[1], association[2]) * Eigen::RowVector3d(1.0, u, v);
        }
      }
    }
    EXPECT_LT((table.ComputeSelfBias(histogram, linear, 8.0) - sums / weight).norm(), 1e-4) << shear;
  }
}

TEST(AssociationTable, UniformWeightsKeepTheAssociation) {
  EventHistogram histogram(12, 1);
  for (int i = 0; i < 50; ++i) histogram.Vote(6.0f, 5.0f, 0, 1.0f);
  AssociationTable biweight, uniform;
  biweight.Build(histogram, 1.5, 0.2);
  uniform.Build(histogram, 1.5, 0.2, AssociationTable::Weighting::kUniform);
  const auto association = biweight.Interpolate(7.0f, 5.0f, 0);
  EXPECT_GT(association[0], 0.1f);
  EXPECT_LT((uniform.Interpolate(7.0f, 5.0f, 0) - association / association[3]).abs().maxCoeff(), 1e-5f);
  EXPECT_EQ(uniform.Interpolate(12.0f, 5.0f, 0)[3], 0.0f);  // the edge is zero
  uniform.Build(histogram, 1.5, 0.2);
  EXPECT_TRUE((uniform.Interpolate(7.0f, 5.0f, 0) == association).all());  // the cached weights depend on the weighting
}

TEST(AssociationTable, InformationOfABlurredLine) {
  EventHistogram histogram(12, 1);
  for (float x = -11.0f; x <= 11.0f; x += 0.25f) {
    for (float y = -4.0f; y <= 4.0f; y += 0.1f) histogram.Vote(x, y, 0, std::exp(-0.5f * y * y));
  }
  AssociationTable table;
  table.Build(histogram, 1.0, 1e-6);
  // Across the line the events have a variance of 1 + 1/6 (of the cells), and the density 1 px^2 more. Gradients are
  // differences over two cells.
  const double events = 1.0 + 1.0 / 6.0;
  double expected = 0.0, total = 0.0;
  for (int y = -8; y <= 8; ++y) {
    const auto density = [&](int at) { return std::exp(-0.5 * at * at / (events + 1.0)); };
    const double weight = std::exp(-0.5 * y * y / events);
    const double slope = 0.5 * (density(y + 1) - density(y - 1)) / density(y);
    expected += weight * slope * slope;
    total += weight;
  }
  const Eigen::Matrix2d information = table.Information(histogram, table);
  EXPECT_NEAR(information(1, 1), expected / total, 0.03);
  EXPECT_NEAR(information(0, 0), 0.0, 0.01);  // it may slide along itself
  EXPECT_NEAR(information(0, 1), 0.0, 1e-3);
}

TEST(AssociationTable, NoiseInOneOfTwoDensitiesGivesNoInformation) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> along(-10.0f, 10.0f);
  std::normal_distribution<float> across(0.0f, 0.5f);
  Eigen::Matrix2d own = Eigen::Matrix2d::Zero(), shared = Eigen::Matrix2d::Zero();
  constexpr int kTrials = 50;
  for (int trial = 0; trial < kTrials; ++trial) {  // each half of the events knows some points of a line
    EventHistogram all(12, 1), halves[2] = {EventHistogram(12, 1), EventHistogram(12, 1)};
    for (int i = 0; i < 60; ++i) {
      const float x = along(random), y = across(random);
      all.Vote(x, y, 0, 1.0f);
      halves[i % 2].Vote(x, y, 0, 1.0f);
    }
    AssociationTable table, tables[2];
    table.Build(all, 1.0, 0.2);
    for (int i = 0; i < 2; ++i) tables[i].Build(halves[i], 1.0, 0.2);
    own += table.Information(all, table) / kTrials;
    shared += tables[0].Information(all, tables[1]) / kTrials;
  }
  EXPECT_GT(own(0, 0), 0.02) << "clumps of the noise";
  EXPECT_LT(std::abs(shared(0, 0)), 0.35 * own(0, 0));
  EXPECT_GT(shared(1, 1), 0.5 * own(1, 1)) << "the line itself";
}

TEST(AssociationTable, KeepsPolaritiesApart) {
  EventHistogram histogram(10, 2);
  histogram.Vote(0.0f, 0.0f, histogram.PlaneOf(1), 10.0f);
  histogram.Vote(4.0f, 0.0f, histogram.PlaneOf(-1), 10.0f);
  AssociationTable table;
  table.Build(histogram, 1.0, 0.1);
  EXPECT_LT(table.Interpolate(1.0f, 0.0f, histogram.PlaneOf(1))[1], 0.0f);
  EXPECT_GT(table.Interpolate(3.0f, 0.0f, histogram.PlaneOf(-1))[1], 0.0f);
}

}  // namespace
}  // namespace evo::tracking
