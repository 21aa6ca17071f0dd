#pragma once

#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "evo/core/error.hpp"
#include "evo/events/event_reader.hpp"
#include "evo/io/open_events.hpp"

namespace evo::io {

/// A folder of its own for each test, removed afterwards.
class IoTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }

  static std::string Content(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() /
      ("evo_io_" + std::to_string(::getpid()) + "_" + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

/// The message of the Error that `action` must throw, which must be one line and of this kind.
inline std::string Refusal(const std::function<void()>& action, ErrorKind kind = ErrorKind::kInput) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

inline void ExpectMentions(const std::string& message, const std::vector<std::string>& parts) {
  for (const auto& part : parts) EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
}

inline events::EventColumns ReadAll(events::EventReader* reader) {
  events::EventColumns all;
  events::EventColumns block;
  while (reader->Next(&block)) {
    EXPECT_GT(block.size(), 0u);
    EXPECT_LE(block.size(), 300'000u);
    all.t.insert(all.t.end(), block.t.begin(), block.t.end());
    all.x.insert(all.x.end(), block.x.begin(), block.x.end());
    all.y.insert(all.y.end(), block.y.begin(), block.y.end());
    all.polarity.insert(all.polarity.end(), block.polarity.begin(), block.polarity.end());
  }
  EXPECT_TRUE(block.empty());
  EXPECT_FALSE(reader->Next(&block));
  EXPECT_DOUBLE_EQ(reader->progress(), 1.0);
  return all;
}

inline events::EventColumns ReadAll(const std::filesystem::path& path, const events::Interval& interval = {},
                                    int width = 346, int height = 260) {
  return ReadAll(OpenEvents(path, interval, width, height).get());
}

inline void ExpectSame(const events::EventColumns& a, const events::EventColumns& b) {
  EXPECT_TRUE(a.t == b.t);
  EXPECT_TRUE(a.x == b.x);
  EXPECT_TRUE(a.y == b.y);
  EXPECT_TRUE(a.polarity == b.polarity);
}

/// Those of `all` with from <= t - first < to: what an interval means, said plainly.
inline events::EventColumns Cut(const events::EventColumns& all, const events::Interval& interval) {
  events::EventColumns cut;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const TimeNs t = all.t[i] - all.t[0];
    if (t >= interval.from && (!interval.to || t < *interval.to)) {
      cut.push_back(all.t[i], all.x[i], all.y[i], all.polarity[i]);
    }
  }
  return cut;
}

/// Deterministic events on a 346 x 260 px sensor: bursts, pauses and many equal stamps. Whole microseconds.
inline events::EventColumns MakeEvents(std::size_t count, TimeNs first) {
  events::EventColumns events;
  std::uint32_t state = 1;
  const auto next = [&state](std::uint32_t below) {
    state = 1664525u * state + 1013904223u;
    return (state >> 8) % below;
  };
  TimeNs t = first;
  for (std::size_t i = 0; i < count; ++i) {
    events.push_back(t, static_cast<std::uint16_t>(next(346)), static_cast<std::uint16_t>(next(260)),
                     next(4) ? std::int8_t{-1} : std::int8_t{1});
    t += 1000 * (next(1000) == 0 ? 20'000 : next(3));
  }
  return events;
}

inline const std::filesystem::path kShared = std::filesystem::path(EVO_SOURCE_DIR) / ".." / "shared";

}  // namespace evo::io
