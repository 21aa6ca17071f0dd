#include "tracking/patch/polarity_flips.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace evo::tracking {
namespace {

using Eigen::Vector2d;

constexpr int kRadius = 12;

/// Events of positive polarity along an edge through the centre, whose normal has this angle.
EventHistogram EdgeHistogram(double normal_angle) {
  EventHistogram histogram(kRadius, 2);
  const Vector2d along(-std::sin(normal_angle), std::cos(normal_angle));
  for (double s = -9.0; s <= 9.0; s += 0.05) {
    histogram.Vote(static_cast<float>(s * along.x()), static_cast<float>(s * along.y()), 0, 1.0f);
  }
  return histogram;
}

TemplateVelocity Translation(double angle, double speed_px_s = 100.0) {
  return {speed_px_s * Vector2d(std::cos(angle), std::sin(angle)), Eigen::Matrix2d::Zero()};
}

/// Ratio of an edge's events that are predicted to be negative after a turn from one direction to another.
double FlippedRatio(double normal_angle, const TemplateVelocity& from, const TemplateVelocity& to,
                    double sigma_px_s = 0.0) {
  EventHistogram histogram = EdgeHistogram(normal_angle);
  PolarityFlips flips;
  flips.Update(histogram, {from, to, sigma_px_s});
  flips.Apply(&histogram);
  double negative = 0.0;
  for (int i = 0; i < histogram.side() * histogram.side(); ++i) negative += histogram.plane(1)[i];
  return negative / histogram.Total();
}

TEST(PolarityFlips, AnEdgeFlipsWhenTheMotionCrossesItsDirection) {
  for (int k = 0; k < 16; ++k) {
    const double start = 2.0 * M_PI * k / 16.0;
    for (const double normal : {0.0, 0.6, -0.6}) {
      for (const double turn : {M_PI, 0.9 * M_PI, 0.5 * M_PI, -0.5 * M_PI, -0.8 * M_PI}) {
        const double before = std::cos(normal);  // of the normal and the first velocity
        const double after = std::cos(normal - turn);
        if (std::abs(after) < 0.5) continue;  // hardly told
        const double ratio = FlippedRatio(start + normal, Translation(start), Translation(start + turn));
        if (before * after < 0.0) {
          EXPECT_GT(ratio, 0.85) << "start " << start << ", normal " << normal << ", turn " << turn;
        } else {
          EXPECT_LT(ratio, 0.15) << "start " << start << ", normal " << normal << ", turn " << turn;
        }
      }
    }
  }
}

TEST(PolarityFlips, AReversalFlipsEveryEdgeAndASteadyMotionNone) {
  for (double normal = 0.0; normal < M_PI; normal += 0.2) {
    EXPECT_GT(FlippedRatio(normal, Translation(0.3), Translation(0.3 + M_PI)), 0.99);
    EXPECT_LT(FlippedRatio(normal, Translation(0.3), Translation(0.3)), 0.01);
  }
}

TEST(PolarityFlips, AnUncertainVelocityTellsNothing) {
  EXPECT_NEAR(FlippedRatio(0.3, Translation(0.3), Translation(0.3 + M_PI, 1.0), 50.0), 0.5, 0.05);
  EXPECT_NEAR(FlippedRatio(0.3, Translation(0.3), Translation(0.3, 1.0), 50.0), 0.5, 0.05);
}

TEST(PolarityFlips, OccurOnlyInATurnOrAnUncertainMotion) {
  const EventHistogram histogram = EdgeHistogram(0.3);
  PolarityFlips flips;
  const auto any = [&](const TemplateVelocity& present) {
    flips.Update(histogram, {Translation(1.0), present, 1.0});
    return flips.any();
  };
  EXPECT_FALSE(any(Translation(1.0)));
  EXPECT_FALSE(any(Translation(1.3)));
  EXPECT_FALSE(any(Translation(1.9)));
  EXPECT_TRUE(any(Translation(2.2)));
  EXPECT_TRUE(any(Translation(1.0 + M_PI)));
  EXPECT_TRUE(any(Translation(1.0, 2.5)));
}

TEST(PolarityFlips, ASteadyRotationAboutThePatchFlipsNothing) {
  TemplateVelocity rotation;
  rotation.rate << 0.0, -20.0, 20.0, 0.0;
  EXPECT_LT(FlippedRatio(0.4, rotation, rotation), 0.05);
  TemplateVelocity opposite = rotation;
  opposite.rate = -rotation.rate;
  EXPECT_GT(FlippedRatio(0.4, rotation, opposite), 0.9);
}

TEST(PolarityFlips, AnEmptyHistogramStaysEmpty) {
  EventHistogram histogram(kRadius, 2);
  PolarityFlips flips;
  flips.Update(histogram, {Translation(0.0, 0.0), Translation(0.0, 0.0), 1.0});
  EXPECT_TRUE(flips.any());
  flips.Apply(&histogram);
  for (int i = 0; i < 2 * histogram.side() * histogram.side(); ++i) EXPECT_EQ(histogram.plane(0)[i], 0.0f);
}

TEST(PolarityFlips, VelocitiesFollowTheCoordinates) {
  PatchMotion motion;
  motion.flow = {10.0, 0.0};
  motion.linear << 0.0, -1.0, 1.0, 0.0;  // the template is seen turned by 90 degrees
  motion.linear_rate << 1.0, 0.0, 0.0, 2.0;
  const TemplateVelocity velocity = VelocityInTemplate(motion);
  EXPECT_LT((velocity.at_centre - Vector2d(0.0, -10.0)).norm(), 1e-12);
  Eigen::Matrix2d rate;
  rate << 2.0, 0.0, 0.0, 1.0;
  EXPECT_LT((velocity.rate - rate).norm(), 1e-12);
}

}  // namespace
}  // namespace evo::tracking
