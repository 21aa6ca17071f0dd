#include "odometry/mapping/mapping_thread.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "odometry/drive_messages.hpp"

namespace evo::odometry {
namespace {

TEST(MappingThread, UpdatesDoNotDependOnTheThread) {
  const auto messages = testing::DriveMessages(40);
  std::vector<std::vector<MapUpdate>> runs;
  for (const bool threaded : {false, true}) {
    Mapper mapper({}, 1.0 / 226.0);
    MappingThread thread(&mapper, threaded);
    auto& updates = runs.emplace_back();
    for (const auto& message : messages) {
      for (auto& update : thread.Collect(message.index - 2)) updates.push_back(std::move(update));
      EXPECT_EQ(updates.size(), static_cast<std::size_t>(std::max(0, message.index - messages[0].index - 1)));
      thread.Post(message);
    }
    for (auto& update : thread.Collect(messages.back().index)) updates.push_back(std::move(update));
  }
  ASSERT_EQ(runs[0].size(), messages.size());
  ASSERT_EQ(runs[1].size(), messages.size());
  for (std::size_t i = 0; i < messages.size(); ++i) {
    EXPECT_EQ(runs[0][i].index, runs[1][i].index);
    EXPECT_EQ(runs[0][i].points, runs[1][i].points);
    EXPECT_EQ(runs[0][i].removed, runs[1][i].removed);
  }
}

}  // namespace
}  // namespace evo::odometry
