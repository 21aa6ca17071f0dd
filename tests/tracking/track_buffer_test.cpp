#include "tracking/smoothing/track_buffer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "evo/geometry/known_cameras.hpp"
#include "tracking/tracker.hpp"

namespace evo::tracking {
namespace {

constexpr TimeNs kFrame = 20'000'000;

/// A buffer whose windows are instants, so that positions do not change, and all that it passes on.
struct KeepingBuffer {
  ThreadPool pool{2};
  events::Tracks passed;
  std::size_t max_held = 0;
  TrackBuffer buffer;

  explicit KeepingBuffer(TrackerOptions options = {})
      : buffer(geometry::Camera(geometry::MvsecDavis346()), options, &pool,
               [this](const events::Tracks& next) { passed.insert(passed.end(), next.begin(), next.end()); }) {}

  /// Observes the features `ids` in frame `frame`.
  void Add(int frame, const std::vector<std::int64_t>& ids, const std::vector<std::int64_t>& rejected = {}) {
    events::Tracks seen;
    for (const auto id : ids) seen.push_back({id, frame * kFrame, 100.0 + static_cast<double>(id), 0.1 * frame});
    buffer.Add(frame * kFrame, seen, std::vector<ObservedWindow>(seen.size()), rejected);
    max_held = std::max(max_held, buffer.held().size());
  }

  std::set<std::int64_t> Ids() const {
    std::set<std::int64_t> ids;
    for (const auto& observation : passed) ids.insert(observation.id);
    return ids;
  }
};

TEST(TrackBuffer, PassesOnAllObservationsOnceInOrder) {
  for (const int frames : {2, 3, 249, 250, 252, 1000, 2003}) {
    KeepingBuffer buffer;
    for (int frame = 0; frame < frames; ++frame) buffer.Add(frame, {1, 2, 3 + frame / 10, 4 + frame / 10});
    buffer.buffer.Finish();
    ASSERT_EQ(buffer.passed.size(), 4u * static_cast<std::size_t>(frames));
    for (std::size_t i = 1; i < buffer.passed.size(); ++i) {
      const auto key = [](const events::TrackObservation& o) { return std::pair(o.t, o.id); };
      ASSERT_LT(key(buffer.passed[i - 1]), key(buffer.passed[i]));
    }
  }
}

TEST(TrackBuffer, HoldsNoMoreForALongStream) {
  KeepingBuffer one, ten;
  for (int frame = 0; frame < 3000; ++frame) one.Add(frame, {1, 2, 3});
  for (int frame = 0; frame < 30000; ++frame) ten.Add(frame, {1, 2, 3});
  EXPECT_EQ(one.max_held, ten.max_held);
  EXPECT_LT(ten.max_held, 3u * 800);
}

TEST(TrackBuffer, DropsFeaturesObservedOnce) {
  KeepingBuffer buffer;
  buffer.Add(0, {1, 2});
  buffer.Add(1, {1, 3});
  buffer.Add(2, {1, 4, 5});
  buffer.Add(3, {5});
  for (int frame = 4; frame < 1000; ++frame) buffer.Add(frame, {1000 + frame});  // a new one each time
  buffer.Add(1000, {3000, 3001});
  buffer.Add(1001, {3000, 3002});
  buffer.buffer.Finish();
  EXPECT_EQ(buffer.Ids(), (std::set<std::int64_t>{1, 5, 3000}));
}

TEST(TrackBuffer, DropsRejectedFeatures) {
  // A feature is rejected as late as possible, whatever its first frame is relative to the segments.
  for (int first = 0; first < 1200; first += 7) {
    KeepingBuffer buffer;
    for (int frame = 0; frame < 1500; ++frame) {
      const int age = frame - first;
      if (age < 0 || age >= kMaxRejectionAge - 1) {
        buffer.Add(frame, {1},
                   age == kMaxRejectionAge - 1 ? std::vector<std::int64_t>{2} : std::vector<std::int64_t>{});
      } else {
        buffer.Add(frame, {1, 2});
      }
    }
    buffer.buffer.Finish();
    ASSERT_EQ(buffer.Ids(), (std::set<std::int64_t>{1})) << first;
    ASSERT_EQ(buffer.passed.size(), 1500u);
  }
}

TEST(TrackBuffer, PassesOnNothingIfNothingIsObserved) {
  KeepingBuffer buffer;
  buffer.buffer.Finish();
  for (int frame = 0; frame < 2000; ++frame) buffer.Add(frame, {});
  buffer.buffer.Finish();
  EXPECT_TRUE(buffer.passed.empty());
}

}  // namespace
}  // namespace evo::tracking
