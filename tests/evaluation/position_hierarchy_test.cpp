#include "evaluation/trajectory/position_hierarchy.hpp"

#include <gtest/gtest.h>

#include <random>

namespace evo::evaluation {
namespace {

TEST(PositionHierarchy, AgreesWithALinearSearch) {
  std::mt19937 random(3);
  std::normal_distribution<double> step(0.0, 0.3);
  for (const std::size_t count : {1u, 2u, 3u, 64u, 257u}) {
    std::vector<Eigen::Vector3d> positions{Eigen::Vector3d::Zero()};
    while (positions.size() < count) {
      const bool stands = positions.size() % 50 > 20;
      positions.push_back(positions.back() +
                          (stands ? Eigen::Vector3d::Zero() : Eigen::Vector3d(step(random), step(random), 0.1)));
    }
    const PositionHierarchy hierarchy(positions);
    for (std::size_t i = 0; i < count; ++i) {  // the position may lie exactly on the ball
      const double radius = (positions[i] - positions[0]).norm();
      ASSERT_LE(hierarchy.FirstOutside(0, positions[0], radius).value_or(count), i);
    }
    for (std::size_t from = 0; from < count; ++from) {
      const Eigen::Vector3d center = positions[from] + Eigen::Vector3d(0.01, 0, 0);
      const auto outside = [&](std::size_t i) { return (positions[i] - center).norm() >= 1.0; };
      std::optional<std::size_t> first;
      for (std::size_t i = from; i < count && !first; ++i) first = outside(i) ? std::optional(i) : std::nullopt;
      std::optional<std::size_t> last;
      for (std::size_t i = from + 1; i > 0 && !last; --i) last = outside(i - 1) ? std::optional(i - 1) : std::nullopt;
      ASSERT_EQ(hierarchy.FirstOutside(from, center, 1.0), first) << count << ' ' << from;
      ASSERT_EQ(hierarchy.LastOutside(from, center, 1.0), last) << count << ' ' << from;
    }
  }
}

}  // namespace
}  // namespace evo::evaluation
