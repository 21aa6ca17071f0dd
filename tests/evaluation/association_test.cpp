#include "evo/evaluation/association.hpp"

#include <gtest/gtest.h>

namespace evo {
namespace {

constexpr TimeNs kMs = 1'000'000;

/// One pose a stamp (ms), moving 1 m/s along x.
Trajectory AtMilliseconds(const std::vector<int>& stamps) {
  Trajectory trajectory;
  for (const int ms : stamps) trajectory.push_back({ms * kMs, SE3({1, 0, 0, 0}, {1e-3 * ms, 0, 0})});
  return trajectory;
}

AssociationOptions Nearest(double max_difference_s) {
  AssociationOptions options;
  options.association = "nearest";
  options.max_difference_s = max_difference_s;
  return options;
}

TEST(Association, NearestWalksTheShorterAndMayTakeAStampTwice) {
  const auto truth = AtMilliseconds({0, 100, 200, 300});
  const auto pairs = Associate(truth, AtMilliseconds({96, 104, 290}), Nearest(0.01));
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[0].t_truth, 100 * kMs);
  EXPECT_EQ(pairs[1].t_truth, 100 * kMs);
  EXPECT_EQ(pairs[2].t_truth, 300 * kMs);
  EXPECT_EQ(pairs[1].t_estimate, 104 * kMs);
  EXPECT_EQ(Associate(truth, AtMilliseconds({1, 2, 98, 101, 111, 250}), Nearest(0.01)).size(), 2u);
}

TEST(Association, NearestToleranceIsInclusiveAndTiesGoToTheEarlier) {
  const auto truth = AtMilliseconds({0, 20, 500});
  const auto pairs = Associate(truth, AtMilliseconds({10, 511}), Nearest(0.01));
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].t_truth, 0);
}

TEST(Association, OffsetMovesTheEstimateWhicheverIsShorter) {
  AssociationOptions options = Nearest(0.001);
  options.estimate_clock_offset_s = -0.05;
  const auto few = AtMilliseconds({100, 200});
  const auto many = AtMilliseconds({50, 100, 150, 200, 250});
  const auto few_estimated = Associate(many, few, options);
  ASSERT_EQ(few_estimated.size(), 2u);
  EXPECT_EQ(few_estimated[0].t_truth, 50 * kMs);
  const auto many_estimated = Associate(few, many, options);
  ASSERT_EQ(many_estimated.size(), 2u);
  EXPECT_EQ(many_estimated[0].t_estimate, 150 * kMs);
}

TEST(Association, InterpolationMeetsTheTruthBetweenItsPoses) {
  const auto pairs = Associate(AtMilliseconds({0, 50, 100}), AtMilliseconds({0, 13, 50, 99}), {});
  ASSERT_EQ(pairs.size(), 4u);
  for (const auto& pair : pairs) {
    EXPECT_NEAR((pair.T_world_cam_truth.translation() - pair.T_world_cam_estimate.translation()).norm(), 0.0, 1e-12);
    EXPECT_EQ(pair.t_truth, pair.t_estimate);
  }
}

TEST(Association, InterpolationNeitherExtrapolatesNorBridgesHoles) {
  const auto truth = AtMilliseconds({100, 200, 900, 1000});
  const auto pairs = Associate(truth, AtMilliseconds({99, 100, 150, 200, 201, 899, 900, 1000, 1001}), {});
  ASSERT_EQ(pairs.size(), 5u);
  EXPECT_EQ(pairs.front().t_truth, 100 * kMs);
  EXPECT_EQ(pairs[3].t_truth, 900 * kMs);
  EXPECT_EQ(pairs.back().t_truth, 1000 * kMs);
}

TEST(Association, EmptyTrajectoriesGiveNoPairs) {
  EXPECT_TRUE(Associate({}, AtMilliseconds({1}), {}).empty());
  EXPECT_TRUE(Associate(AtMilliseconds({1}), {}, Nearest(1)).empty());
}

}  // namespace
}  // namespace evo
