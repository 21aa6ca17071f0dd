#include "tracking/detection/refill_policy.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace evo::tracking {
namespace {

/// Those of 20 frames in which new features are due if so many are alive in each.
std::vector<int> RefilledFrames(std::size_t alive) {
  TrackerOptions options;
  options.features = 100;
  options.refill_below = 0.9;
  options.frames_between_refills = 5;
  RefillPolicy policy(options);
  std::vector<int> frames;
  for (int frame = 0; frame < 20; ++frame) {
    if (policy.IsDue(alive)) frames.push_back(frame);
  }
  return frames;
}

TEST(RefillPolicy, IsDueIfTooFewAreAliveButNotInEveryFrame) {
  EXPECT_EQ(RefilledFrames(89), (std::vector<int>{0, 5, 10, 15}));
  EXPECT_EQ(RefilledFrames(50), (std::vector<int>{0, 5, 10, 15}));
  EXPECT_TRUE(RefilledFrames(90).empty());
}

TEST(RefillPolicy, IsDueSoonerIfMostAreMissing) {
  EXPECT_EQ(RefilledFrames(49), (std::vector<int>{0, 3, 6, 9, 12, 15, 18}));
}

}  // namespace
}  // namespace evo::tracking
