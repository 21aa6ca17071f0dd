#include "evo/core/time.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace evo {
namespace {

TEST(Time, ParsesEveryDigitOfAnEpochStamp) {
  EXPECT_EQ(ParseTime("1468941032.255472635"), 1468941032255472635);
  EXPECT_EQ(ParseTime("0.003811000"), 3811000);
  EXPECT_EQ(ParseTime("-0.5"), -500000000);
  EXPECT_EQ(ParseTime("12"), 12 * kNsPerSecond);
  EXPECT_EQ(ParseTime(".25"), 250000000);
  EXPECT_EQ(ParseTime("1.0000000005"), 1000000001);
  EXPECT_EQ(ParseTime("1.5e-3"), 1500000);
}

TEST(Time, RefusesWhatIsNotAFiniteNumber) {
  for (const char* text : {"", "-", ".", "nan", "inf", "1.2.3", "12s", "1e", " 1", "99999999999", "1e300"}) {
    EXPECT_FALSE(ParseTime(text)) << text;
  }
}

TEST(Time, FormatsExactlyAndReadsBack) {
  EXPECT_EQ(FormatTime(1468941032255472635), "1468941032.255472635");
  EXPECT_EQ(FormatTime(-500000001), "-0.500000001");
  for (const TimeNs t : {TimeNs{0}, TimeNs{1}, TimeNs{-1}, TimeNs{1504645177420000123}}) {
    EXPECT_EQ(ParseTime(FormatTime(t)), t);
  }
}

TEST(Time, RoundsSecondsToTheNearestNanosecond) {
  EXPECT_EQ(FromSeconds(0.1), 100000000);
  EXPECT_EQ(FromSeconds(-0.1), -100000000);
  EXPECT_NEAR(static_cast<double>(FromSeconds(1504645177.42) - 1504645177420000000), 0.0, 240.0);
}

}  // namespace
}  // namespace evo
