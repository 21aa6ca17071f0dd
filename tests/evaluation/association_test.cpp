#include "evaluation/trajectory/association.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "evo/core/error.hpp"

namespace evo::evaluation {
namespace {

constexpr TimeNs kMs = 1'000'000;

/// One pose a stamp (ms), moving 1 m/s along x.
geometry::Trajectory AtMilliseconds(const std::vector<int>& stamps) {
  geometry::Trajectory trajectory;
  for (const int ms : stamps) trajectory.push_back({ms * kMs, geometry::SE3({1, 0, 0, 0}, {1e-3 * ms, 0, 0})});
  return trajectory;
}

AssociationOptions Nearest(double max_difference_s) {
  AssociationOptions options;
  options.association = "nearest";
  options.max_difference_s = max_difference_s;
  return options;
}

TEST(Association, NearestStartsFromTheShorterTrajectoryAndMayReuseStamps) {
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

AssociationOptions Rule(const std::string& association, double max_difference_s) {
  AssociationOptions options = Nearest(max_difference_s);
  options.association = association;
  return options;
}

TEST(Association, UniqueMatchesTheNearestTwoFirst) {
  const auto truth = AtMilliseconds({0, 100, 110, 200});
  // 104 is nearest to 100 and 106 to 110, but 103 would be nearer to 100 than to anything that is left.
  const auto pairs = Associate(truth, AtMilliseconds({103, 104, 108, 290}), Rule("unique", 0.2));
  ASSERT_EQ(pairs.size(), 4u);
  const std::vector<std::pair<int, int>> expected{{0, 104}, {100, 103}, {110, 108}, {200, 290}};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_EQ(pairs[i].t_truth, expected[i].first * kMs);
    EXPECT_EQ(pairs[i].t_estimate, expected[i].second * kMs);
  }
  EXPECT_EQ(Associate(truth, AtMilliseconds({103, 104, 108, 290}), Rule("unique", -1.0)).size(), 2u);  // 0.02 s
}

TEST(Association, UniqueIsTheGreedyChoiceAmongAllPairs) {
  std::mt19937 random(7);
  for (int round = 0; round < 50; ++round) {
    std::set<int> a;
    std::set<int> b;
    for (int i = 0; i < 30; ++i) {
      a.insert(static_cast<int>(random() % 200));
      b.insert(static_cast<int>(random() % 200));
    }
    std::vector<std::tuple<int, int, int>> all;
    for (const int t : a) {
      for (const int e : b) {
        if (std::abs(t - e) <= 9) all.emplace_back(std::abs(t - e), t, e);
      }
    }
    std::ranges::sort(all);
    std::map<int, int> expected;
    std::set<int> taken;
    for (const auto& [difference, t, e] : all) {
      if (!expected.contains(t) && taken.insert(e).second) expected[t] = e;
    }
    const auto pairs =
        Associate(AtMilliseconds({a.begin(), a.end()}), AtMilliseconds({b.begin(), b.end()}), Rule("unique", 0.009));
    std::map<int, int> found;
    for (const auto& pair : pairs) {
      found[static_cast<int>(pair.t_truth / kMs)] = static_cast<int>(pair.t_estimate / kMs);
    }
    EXPECT_EQ(found, expected) << round;
  }
}

TEST(Association, NearestTruthStartsFromTheEstimate) {
  const auto truth = AtMilliseconds({0, 50, 100});
  const auto estimate = AtMilliseconds({10, 20, 60, 140, 199, 201});
  const auto pairs = Associate(truth, estimate, Rule("nearest-truth", -1.0));  // up to twice 50 ms
  ASSERT_EQ(pairs.size(), 5u);
  EXPECT_EQ(pairs[1].t_truth, 0);
  EXPECT_EQ(pairs[4].t_estimate, 199 * kMs);
  EXPECT_EQ(Associate(truth, estimate, Rule("nearest-truth", 0.01)).size(), 2u);
}

TEST(Association, IndexPairsPoseByPose) {
  const auto a = AtMilliseconds({0, 1000, 2000});
  const auto pairs = Associate(a, AtMilliseconds({0, 1000, 2000}), Rule("index", -1.0));
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[2].t_truth, 2000 * kMs);
  try {
    Associate(a, AtMilliseconds({0, 1000}), Rule("index", -1.0));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_NE(std::string(error.what()).find("has 2 and the ground truth 3"), std::string::npos) << error.what();
  }
}

TEST(Association, OffsetAppliesToTheEstimateWhicheverIsShorter) {
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

TEST(Association, InterpolationIsExactBetweenTruePoses) {
  const auto pairs = Associate(AtMilliseconds({0, 50, 100}), AtMilliseconds({0, 13, 50, 99}), {});
  ASSERT_EQ(pairs.size(), 4u);
  for (const auto& pair : pairs) {
    EXPECT_NEAR((pair.T_world_cam_truth.translation() - pair.T_world_cam_estimate.translation()).norm(), 0.0, 1e-12);
    EXPECT_EQ(pair.t_truth, pair.t_estimate);
  }
}

TEST(Association, InterpolationNeitherExtrapolatesNorBridgesGaps) {
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
}  // namespace evo::evaluation
