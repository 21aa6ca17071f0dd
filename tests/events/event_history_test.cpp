#include "evo/events/event_history.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace evo::events {
namespace {

constexpr TimeNs kEver = std::numeric_limits<TimeNs>::min();

constexpr int kWidth = 50;
constexpr int kHeight = 37;

EventColumns RandomEvents(std::size_t count, TimeNs begin, TimeNs end) {
  std::mt19937 random(7);
  EventColumns events;
  std::vector<TimeNs> stamps(count);
  for (TimeNs& t : stamps) t = begin + static_cast<TimeNs>(random() % static_cast<std::uint64_t>(end - begin));
  std::ranges::sort(stamps);
  for (const TimeNs t : stamps) {
    events.push_back(t, static_cast<std::uint16_t>(random() % kWidth), static_cast<std::uint16_t>(random() % kHeight),
                     random() % 2 ? 1 : -1);
  }
  return events;
}

TEST(EventHistory, FindsTheWindowOfTheNewestEvents) {
  const EventColumns events = RandomEvents(3000, -10'000'000, 5'000'000);
  EventHistory history(kWidth, kHeight);
  EXPECT_EQ(history.NewestWindowBegin(kEver, 7, 10), 7);
  history.Append(events);
  for (const TimeNs end : {-9'000'000, -3'000'000, 0, 1'234'567, 5'000'000, 8'000'000}) {
    const auto before = std::ranges::lower_bound(events.t, end) - events.t.begin();
    for (const std::ptrdiff_t count : {1, 2, 150, 999, 2000}) {
      const TimeNs expected = count <= before ? events.t[static_cast<std::size_t>(before - count)] : events.t.front();
      EXPECT_EQ(history.NewestWindowBegin(kEver, end, static_cast<std::size_t>(count)), expected)
          << end << ' ' << count;
    }
  }
}

using Row = std::tuple<float, float, float, int>;

std::vector<Row> Sorted(const LocalEvents& local) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < local.size(); ++i)
    rows.emplace_back(local.dt[i], local.x[i], local.y[i], local.polarity[i]);
  std::ranges::sort(rows);
  return rows;
}

TEST(EventHistory, GathersTheEventsOfAMovingPatch) {
  // Stamps on both sides of zero and a gap without events.
  EventColumns events = RandomEvents(3000, -10'000'000, 5'000'000);
  EventHistory history(kWidth, kHeight);
  history.Append(events);
  history.Append(RandomEvents(1000, 9'500'000, 12'000'000));
  const EventColumns later = RandomEvents(1000, 9'500'000, 12'000'000);
  for (std::size_t i = 0; i < later.size(); ++i) {
    events.push_back(later.t[i], later.x[i], later.y[i], later.polarity[i]);
  }
  const MovingPatch patches[] = {{0, 25, 18, 0, 0, 6, 4'000'000},
                                 {-3'000'000, 4, 30, 900, -700, 5, 3'000'000},
                                 {10'000'000, 49, 0, -2000, 100, 9, 2'500'000}};
  for (const MovingPatch& patch : patches) {
    std::vector<Row> expected;
    for (std::size_t i = 0; i < events.size(); ++i) {
      const double dt = ToSeconds(events.t[i] - patch.t);
      const double x = events.x[i] - patch.x;
      const double y = events.y[i] - patch.y;
      if (std::abs(events.t[i] - patch.t) > patch.half_window) continue;
      if (std::abs(x - patch.vx * dt) > patch.radius || std::abs(y - patch.vy * dt) > patch.radius) continue;
      expected.emplace_back(dt, x, y, events.polarity[i]);
    }
    std::ranges::sort(expected);
    LocalEvents local;
    history.Gather(patch, &local);
    const auto found = Sorted(local);
    ASSERT_EQ(found.size(), expected.size());
    EXPECT_GT(found.size(), 10u);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(std::get<0>(found[i]), std::get<0>(expected[i]), 1e-8);
      EXPECT_EQ(std::get<1>(found[i]), std::get<1>(expected[i]));
      EXPECT_EQ(std::get<3>(found[i]), std::get<3>(expected[i]));
    }
  }
}

TEST(EventHistory, DoesNotDependOnHowTheStreamIsCutIntoBlocks) {
  const EventColumns events = RandomEvents(2000, 0, 20'000'000);
  EventHistory whole(kWidth, kHeight), pieces(kWidth, kHeight);
  whole.Append(events);
  EventColumns piece;
  for (std::size_t i = 0; i < events.size(); ++i) {
    piece.push_back(events.t[i], events.x[i], events.y[i], events.polarity[i]);
    if (i % 77 == 0) {
      pieces.Append(piece);
      piece.clear();
    }
  }
  pieces.Append(piece);
  LocalEvents a, b;
  const MovingPatch patch{10'000'000, 25, 18, 100, 50, 10, 10'000'000};
  whole.Gather(patch, &a);
  pieces.Gather(patch, &b);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.dt, b.dt);
}

TEST(EventHistory, ForgetsDroppedEvents) {
  const EventColumns events = RandomEvents(2000, 0, 20'000'000);
  EventHistory history(kWidth, kHeight);
  history.Append(events);
  const auto count = [&](TimeNs begin, TimeNs end) {
    std::ptrdiff_t visited = 0;
    history.ForEachBetween(begin, end, [&](int, int, TimeNs, std::int8_t) { ++visited; });
    return visited;
  };
  EXPECT_EQ(count(0, 20'000'000), 2000);
  history.DropBefore(10'000'000);
  EXPECT_EQ(count(0, 10'000'000), 0);
  const auto kept = std::ranges::count_if(events.t, [](TimeNs t) { return t >= 10'000'000; });
  EXPECT_GT(kept, 0);
  EXPECT_EQ(count(0, 20'000'000), kept);
}

TEST(EventHistory, AcceptsStampsOfAnySize) {
  // A slice stores its stamps in 32 bits; these blocks are farther apart.
  constexpr TimeNs kWrap = TimeNs{1} << 32;
  EventHistory history(kWidth, kHeight);
  for (const TimeNs middle : {kWrap / 2, kWrap, 7 * kWrap, 1000000 * kWrap}) {
    history.DropBefore(middle - 10'000'000);
    const EventColumns events = RandomEvents(2000, middle - 10'000'000, middle + 10'000'000);
    history.Append(events);
    std::vector<TimeNs> found;
    history.ForEachBetween(middle - 5'000'000, middle + 5'000'000,
                           [&](int, int, TimeNs t, std::int8_t) { found.push_back(t); });
    std::ranges::sort(found);
    std::vector<TimeNs> expected;
    std::ranges::copy_if(events.t, std::back_inserter(expected),
                         [&](TimeNs t) { return t >= middle - 5'000'000 && t < middle + 5'000'000; });
    EXPECT_GT(expected.size(), 500u);
    EXPECT_EQ(found, expected);
  }
}

TEST(EventHistory, RefusesAWindowThatIsTooLong) {
  EventHistory history(kWidth, kHeight);
  const EventColumns events = RandomEvents(100, 0, 2 * EventHistory::kMaxHalfWindow);
  history.Append(events);
  LocalEvents local;
  MovingPatch patch{EventHistory::kMaxHalfWindow, 25, 18, 0, 0, 50, EventHistory::kMaxHalfWindow};
  history.Gather(patch, &local);
  EXPECT_EQ(local.size(), events.size());
  ++patch.half_window;
  EXPECT_THROW(history.Gather(patch, &local), std::length_error);
}

TEST(LocalEvents, AreSubsampledEvenly) {
  LocalEvents local;
  for (int i = 0; i < 100; ++i) {
    local.x.push_back(static_cast<float>(i));
    local.y.push_back(0);
    local.dt.push_back(0);
    local.polarity.push_back(1);
  }
  local.Subsample(200);
  EXPECT_EQ(local.size(), 100u);
  local.Subsample(20);
  ASSERT_EQ(local.size(), 20u);
  for (std::size_t i = 0; i < local.size(); ++i) EXPECT_EQ(local.x[i], 5.0f * static_cast<float>(i));
}

}  // namespace
}  // namespace evo::events
