#include "evo/core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace evo {
namespace {

TEST(ThreadPool, VisitsEveryIndexOnceForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.size(), threads);
    for (const std::size_t count : {0u, 1u, 7u, 1000u}) {
      std::vector<int> visits(count, 0);
      pool.ForEach(
          count, [&](std::size_t i) { ++visits[i]; }, 3);
      EXPECT_EQ(visits, std::vector<int>(count, 1));
    }
  }
}

TEST(ThreadPool, SurvivesManyShortJobs) {
  ThreadPool pool(4);
  std::atomic<int> sum{0};
  for (int round = 0; round < 2000; ++round) pool.ForEach(8, [&](std::size_t) { ++sum; });
  EXPECT_EQ(sum, 16000);
}

TEST(ThreadPool, RethrowsTheErrorOfTheLowestIndexAfterAllWorkIsDone) {
  ThreadPool pool(3);
  std::atomic<int> done{0};
  try {
    pool.ForEach(100, [&](std::size_t i) {
      ++done;
      if (i == 20 || i == 70) throw std::runtime_error(std::to_string(i));
    });
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "20");
  }
  EXPECT_EQ(done, 100);
}

}  // namespace
}  // namespace evo
