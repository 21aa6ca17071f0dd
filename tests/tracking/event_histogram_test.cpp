#include "tracking/patch/event_histogram.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

namespace evo::tracking {
namespace {

TEST(EventHistogram, VotesAreBilinear) {
  EventHistogram histogram(5, 2);
  histogram.Vote(0.25f, -1.5f, 1, 2.0f);
  EXPECT_FLOAT_EQ(static_cast<float>(histogram.Total()), 2.0f);
  const float* plane = histogram.plane(1);
  const auto cell = [&](int x, int y) { return plane[(y + 5) * histogram.side() + x + 5]; };
  EXPECT_FLOAT_EQ(cell(0, -2), 2.0f * 0.75f * 0.5f);
  EXPECT_FLOAT_EQ(cell(1, -1), 2.0f * 0.25f * 0.5f);
  histogram.Vote(5.5f, 0.0f, 0, 1.0f);
  for (const float far : {std::nanf(""), INFINITY, -INFINITY, 1e10f, -1e10f}) {
    histogram.Vote(far, 0.0f, 0, 1.0f);
    histogram.Vote(0.0f, far, 0, 1.0f);
  }
  EXPECT_FLOAT_EQ(static_cast<float>(histogram.Total()), 2.0f);
}

TEST(EventHistogram, ManyEventsVoteLikeSingleOnes) {
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
    EventHistogram together(5, planes), apart(5, planes);
    together.Vote(x, y, polarity);
    for (std::size_t i = 0; i < x.size(); ++i) apart.Vote(x[i], y[i], apart.PlaneOf(polarity[i]), 1.0f);
    EXPECT_GT(apart.Total(), 30.0);
    for (int i = 0; i < planes * apart.side() * apart.side(); ++i) {
      EXPECT_NEAR(together.plane(0)[i], apart.plane(0)[i], 1e-5) << i;
    }
  }
}

TEST(EventHistogram, TotalIsTheSumOfTheCells) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> place(-6.0f, 6.0f);
  const auto random_histogram = [&] {
    EventHistogram histogram(5, 2);
    for (int i = 0; i < 20; ++i) histogram.Vote(place(random), place(random), i % 2, 0.1f * static_cast<float>(i));
    std::vector<float> x, y;
    for (int i = 0; i < 61; ++i) {
      x.push_back(place(random));
      y.push_back(place(random));
    }
    histogram.Vote(x, y, std::vector<std::int8_t>(x.size(), 1));
    return histogram;
  };
  const auto expect_sum = [](const EventHistogram& histogram) {
    double sum = 0.0;
    for (int p = 0; p < 2; ++p)
      sum = std::accumulate(histogram.plane(p), histogram.plane(p) + histogram.side() * histogram.side(), sum);
    EXPECT_NEAR(histogram.Total(), sum, 1e-4 * sum);
  };
  EventHistogram histogram = random_histogram();
  expect_sum(histogram);
  histogram.Scale(0.3f);
  expect_sum(histogram);
  histogram.Blend(0.8f, random_histogram(), 0.1f);
  expect_sum(histogram);
  expect_sum(histogram.Warped(Eigen::Rotation2Dd(0.4).toRotationMatrix()));
  histogram.Clear();
  EXPECT_EQ(histogram.Total(), 0.0);
}

TEST(EventHistogram, WarpMovesCellsAndKeepsTheNumberOfEvents) {
  EventHistogram histogram(12, 1);
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) histogram.Vote(4.0f + 0.5f * i, 2.0f + 0.5f * j, 0, 1.0f);
  }
  Eigen::Matrix2d linear;
  linear << 1.5, 0.0, 0.0, 1.5;
  const EventHistogram warped = histogram.Warped(linear);
  EXPECT_NEAR(warped.Total(), histogram.Total(), 0.05 * histogram.Total());
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

TEST(EventHistogram, WarpFollowsThePerspective) {
  EventHistogram histogram(12, 1);
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) histogram.Vote(4.0f + 0.5f * i, -6.0f + 0.5f * j, 0, 1.0f);
  }
  const Eigen::Vector2d perspective(0.02, -0.03);
  const EventHistogram warped = histogram.Warped(Eigen::Matrix2d::Identity(), perspective);
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

TEST(EventHistogram, EffectiveCellsCountsHowFarEventsSpread) {
  EventHistogram histogram(6, 1);
  for (int i = 0; i < 100; ++i) histogram.Vote(0.0f, 0.0f, 0, 1.0f);
  EXPECT_NEAR(histogram.EffectiveCells(), 1.0, 1e-6);
  histogram.Clear();
  for (int i = -4; i < 4; ++i) histogram.Vote(static_cast<float>(i), 0.0f, 0, 1.0f);
  EXPECT_NEAR(histogram.EffectiveCells(), 8.0, 1e-5);
}

}  // namespace
}  // namespace evo::tracking
