#include "evo/evaluation/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace evo::evaluation {
namespace {

TEST(Statistics, AreNanForAnEmptyList) {
  EXPECT_EQ(ComputeStatistics({}).count, 0);
  EXPECT_TRUE(std::isnan(ComputeStatistics({}).rmse));
}

}  // namespace
}  // namespace evo::evaluation
