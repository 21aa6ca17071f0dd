#include "evaluation/trajectory/pair_selection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "evo/core/error.hpp"

namespace evo::evaluation {
namespace {

/// Poses along x at `positions` (m), turning 1 degree a metre about z, 0.1 s apart.
std::vector<geometry::StampedPose> Along(const std::vector<double>& positions) {
  std::vector<geometry::StampedPose> poses;
  for (const double x : positions) {
    poses.push_back({static_cast<TimeNs>(poses.size()) * 100'000'000,
                     geometry::SE3(geometry::so3::Exp({0, 0, x * std::numbers::pi / 180.0}), {x, 0, 0})});
  }
  return poses;
}

std::vector<geometry::StampedPose> AtSeconds(const std::vector<double>& stamps) {
  std::vector<geometry::StampedPose> poses;
  for (const double s : stamps) poses.push_back({FromSeconds(s), geometry::SE3()});
  return poses;
}

std::vector<std::pair<int, int>> Select(const std::vector<geometry::StampedPose>& poses, const char* delta,
                                        const char* selection, double tolerance = 0.1) {
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [i, j] : SelectPairs(poses, ParseDeltas(delta).front(), selection, tolerance)) {
    pairs.emplace_back(static_cast<int>(i), static_cast<int>(j));
  }
  return pairs;
}

using Pairs = std::vector<std::pair<int, int>>;

TEST(PairSelection, ParsesDeltas) {
  const auto deltas = ParseDeltas("10f,0.5s,10m,5deg,0.1rad,10m");
  ASSERT_EQ(deltas.size(), 5u);
  EXPECT_EQ(deltas[1].unit, DeltaUnit::kSeconds);
  EXPECT_EQ(deltas[1].value, 0.5);
  EXPECT_EQ(deltas[3].name, "5deg");
  for (const char* text :
       {"", "1", "f", "0f", "1.5f", "-1m", "nanm", "infm", "181deg", "3.2rad", "10d", "1f,,1s", "1 m", "1e9s"}) {
    try {
      ParseDeltas(text);
      ADD_FAILURE() << "accepted " << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    }
  }
}

TEST(PairSelection, Frames) {
  const auto poses = Along({0, 1, 2, 3, 4, 5, 6});
  EXPECT_EQ(Select(poses, "3f", "consecutive"), (Pairs{{0, 3}, {3, 6}}));
  EXPECT_EQ(Select(poses, "4f", "consecutive"), (Pairs{{0, 4}}));
  EXPECT_EQ(Select(poses, "4f", "all"), (Pairs{{0, 4}, {1, 5}, {2, 6}}));
  EXPECT_EQ(Select(poses, "4f", "closest"), (Pairs{{0, 4}, {1, 5}}));
  for (const char* selection : {"consecutive", "all", "closest"}) {
    EXPECT_TRUE(Select(poses, "7f", selection).empty()) << selection;
    EXPECT_TRUE(Select({}, "1f", selection).empty()) << selection;
    EXPECT_TRUE(Select(Along({0}), "1f", selection).empty()) << selection;
  }
}

TEST(PairSelection, MetresStartAtTheFirstCrossing) {
  const auto poses = Along({0, 0.6, 1.2, 1.8, 2.4, 3.0, 3.6});
  EXPECT_EQ(Select(poses, "1m", "consecutive"), (Pairs{{2, 4}, {4, 6}}));
  EXPECT_EQ(Select(poses, "1m", "all"), Pairs{});  // 0.6 and 1.2 are not within 10 %
  EXPECT_EQ(Select(poses, "1m", "all", 0.25).size(), 5u);
  EXPECT_EQ(Select(poses, "1m", "closest").size(), 4u);
}

TEST(PairSelection, AnglesStartAtTheFirstPose) {
  const auto poses = Along({0, 6, 12, 18, 24, 30});  // degrees too
  EXPECT_EQ(Select(poses, "10deg", "consecutive"), (Pairs{{0, 2}, {2, 4}}));
  EXPECT_EQ(Select(poses, "12deg", "all"), (Pairs{{0, 2}, {1, 3}, {2, 4}, {3, 5}}));
  EXPECT_EQ(Select(poses, "0.2094395rad", "all"), Select(poses, "12deg", "all"));
}

TEST(PairSelection, AnglesOfAllPairsMayHaveSeveralEnds) {
  const auto poses = Along({0, 10, 10.5, 0, 10});
  EXPECT_EQ(Select(poses, "10deg", "all"), (Pairs{{0, 1}, {0, 2}, {0, 4}, {1, 3}, {2, 3}, {3, 4}}));
}

TEST(PairSelection, TooManyPairsByAngleAreRefused) {
  std::vector<double> positions;  // each pose is turned by 10 degrees against every second one
  for (int i = 0; i < 7000; ++i) positions.push_back(i % 2 ? 10.0 : 0.0);
  EXPECT_THROW(Select(Along(positions), "10deg", "all"), Error);
}

TEST(PairSelection, SecondsByHand) {
  // A jitter of 1 ms, then a gap of 3 s.
  const auto poses = AtSeconds({0.0, 0.5, 0.999, 1.5, 2.001, 5.0, 5.5, 6.0});
  EXPECT_EQ(Select(poses, "1s", "consecutive"), (Pairs{{0, 2}, {2, 4}, {5, 7}}));
  EXPECT_EQ(Select(poses, "1s", "all"), (Pairs{{0, 2}, {1, 3}, {2, 4}, {5, 7}}));
  EXPECT_EQ(Select(poses, "1s", "closest"), (Pairs{{0, 2}, {1, 3}, {2, 4}, {3, 4}, {4, 5}}));
  EXPECT_EQ(Select(poses, "1s", "all", 0.0), (Pairs{{1, 3}, {5, 7}}));
}

TEST(PairSelection, AllPairsAgreeWithAnExhaustiveSearch) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> step(0.0, 0.5);
  std::vector<double> positions{0.0};
  for (int i = 1; i < 300; ++i) positions.push_back(positions.back() + (i % 40 > 30 ? 0.0 : step(random)));
  const auto poses = Along(positions);
  std::vector<double> path{0.0};
  for (std::size_t i = 1; i < poses.size(); ++i) {
    path.push_back(path.back() + (poses[i].T_world_cam.translation() - poses[i - 1].T_world_cam.translation()).norm());
  }
  for (const double tolerance : {0.0, 0.05, 0.5}) {
    Pairs nearest;
    Pairs angles;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      std::size_t best = i;
      for (std::size_t j = i + 1; j < poses.size(); ++j) {
        const double miss = std::abs(path[j] - path[i] - 3.0);
        if (best == i || miss < std::abs(path[best] - path[i] - 3.0)) best = j;
        const Eigen::Quaterniond turn = poses[i].T_world_cam.rotation().conjugate() * poses[j].T_world_cam.rotation();
        const double angle = geometry::so3::Log(turn).norm() * 180.0 / std::numbers::pi;
        if (std::abs(angle - 7.0) <= 7.0 * tolerance) angles.emplace_back(i, j);
      }
      if (best > i && std::abs(path[best] - path[i] - 3.0) <= 3.0 * tolerance) nearest.emplace_back(i, best);
    }
    EXPECT_EQ(Select(poses, "3m", "all", tolerance), nearest) << tolerance;
    EXPECT_EQ(Select(poses, "7deg", "all", tolerance), angles) << tolerance;
  }
}

}  // namespace
}  // namespace evo::evaluation
