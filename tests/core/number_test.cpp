#include "evo/core/number.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace evo {
namespace {

TEST(FormatNumberTest, ShortestTextThatReadsBack) {
  EXPECT_EQ(FormatNumber(0.1), "0.1");
  EXPECT_EQ(FormatNumber(100.0), "100");
  EXPECT_EQ(FormatNumber(1e6), "1e+06");
  EXPECT_EQ(FormatNumber(-std::numeric_limits<double>::min()), "-2.2250738585072014e-308");
  EXPECT_EQ(FormatNumber(std::nan("")), "nan");
}

}  // namespace
}  // namespace evo
