#include "odometry/mapping/mapper.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "odometry/drive_messages.hpp"

namespace evo::odometry {
namespace {

using testing::DriveMessages;

TEST(Mapper, GrowsTheMapAndRemovesContradictedPoints) {
  Mapper mapper({}, 1.0 / 226.0);
  auto messages = DriveMessages(60);
  const std::size_t initial = messages[0].new_map->size();
  const std::int64_t victim = messages[0].new_map->front().track;
  bool removed = false;
  for (auto& message : messages) {
    if (mapper.map().Find(victim)) message.outliers.push_back(victim);
    const MapUpdate update = mapper.Process(message);
    EXPECT_EQ(update.index, message.index);
    removed |= std::ranges::find(update.removed, victim) != update.removed.end();
  }
  EXPECT_TRUE(removed);
  EXPECT_GT(mapper.map().points.size(), initial + 50);
  EXPECT_EQ(mapper.map().key_frames.size(), 12u);
}

TEST(Mapper, OldKeyFramesMakeSeedsConvergeEarlier) {
  std::vector<std::size_t> points;
  for (const int old_key_frames : {0, 6}) {
    MapperOptions options;
    options.old_key_frames = old_key_frames;
    options.depth_filter.max_age = 1;  // most seeds are dropped and created again
    options.depth_filter.convergence = 500.0;
    Mapper mapper(options, 1.0 / 226.0);
    points.push_back(0);
    for (const auto& message : DriveMessages(60)) {
      mapper.Process(message);
      points.back() += mapper.map().points.size();
    }
  }
  EXPECT_GT(points[1], points[0]);  // summed over the frames
}

}  // namespace
}  // namespace evo::odometry
