#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "io/support.hpp"

namespace evo::io {
namespace {

std::string ToText(const events::EventColumns& events) {
  std::ostringstream text;
  for (std::size_t i = 0; i < events.size(); ++i) {
    text << FormatTime(events.t[i]) << ' ' << events.x[i] << ' ' << events.y[i] << ' ' << (events.polarity[i] > 0)
         << '\n';
  }
  return text.str();
}

class TextEventsTest : public IoTest {
 protected:
  std::string RefusalOf(const std::string& text) const {
    const auto path = Write("bad.txt", text);
    return Refusal([&] { ReadAll(path); });
  }
};

TEST_F(TextEventsTest, ReadsWhatWasWrittenInSeveralBlocks) {
  const events::EventColumns events = MakeEvents(200'000, 1468940293'955124000);
  const auto path = Write("events.txt", ToText(events));
  ExpectSame(ReadAll(path), events);
  EXPECT_EQ(OpenEvents(path, {}, 346, 260)->first_stamp(), events.t[0]);
  EXPECT_EQ(OpenEvents(path, {}, 346, 260)->last_stamp(), events.t.back());
}

TEST_F(TextEventsTest, ReadsEveryFormOfALine) {
  const auto path = Write("events.txt",
                          "# t x y p\n"
                          "\n"
                          "0.5 1 2 0\r\n"
                          "0.500000001 345 259 1\n"
                          "  0.6\t3   4 -1 \n"
                          "1 5 6 1\n"
                          "# in between\n"
                          "1.0000000014 7 8 -1\n"
                          "1.0000000015 7 8 1\n"
                          "1.5e0 9 10 0\n"
                          "1468941032.255472635 11 12 -1");
  const events::EventColumns events = ReadAll(path);
  EXPECT_EQ(events.t, (std::vector<TimeNs>{500000000, 500000001, 600000000, 1000000000, 1000000001, 1000000002,
                                           1500000000, 1468941032255472635}));
  EXPECT_EQ(events.x, (std::vector<std::uint16_t>{1, 345, 3, 5, 7, 7, 9, 11}));
  EXPECT_EQ(events.y, (std::vector<std::uint16_t>{2, 259, 4, 6, 8, 8, 10, 12}));
  EXPECT_EQ(events.polarity, (std::vector<std::int8_t>{-1, 1, -1, 1, -1, 1, -1, -1}));
}

TEST_F(TextEventsTest, KeepsEveryDigitOfAStamp) {
  const std::string digits = "123456789";
  for (std::size_t decimals = 0; decimals <= digits.size(); ++decimals) {
    std::string stamp = "12";
    if (decimals > 0) stamp.append(".").append(digits, 0, decimals);
    const events::EventColumns events = ReadAll(Write("events.txt", stamp + " 1 2 1\n"));
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events.t[0], *ParseTime(stamp)) << stamp;
  }
}

TEST_F(TextEventsTest, IntervalsEqualACutOfTheWholeFile) {
  const events::EventColumns events = MakeEvents(20'000, 3'811'000);
  const auto path = Write("events.txt", "# a comment\n" + ToText(events) + "\n# the end\n");
  const TimeNs length = events.t.back() - events.t.front();
  for (int i = 0; i < 40; ++i) {
    const TimeNs from = length * i / 41;
    for (const TimeNs duration : {TimeNs{1000}, length / 7, length}) {
      const events::Interval interval{from, from + duration};
      const events::EventColumns expected = Cut(events, interval);
      if (expected.empty()) continue;
      ExpectSame(ReadAll(path, interval), expected);
    }
    ExpectSame(ReadAll(path, {events.t[500u * static_cast<unsigned>(i)] - events.t[0], {}}),
               Cut(events, {events.t[500u * static_cast<unsigned>(i)] - events.t[0], {}}));
  }
}

TEST_F(TextEventsTest, IntervalReadsNothingBeforeIt) {
  const events::EventColumns events = MakeEvents(100'000, 0);
  std::string text = ToText(events);
  const std::size_t early = text.find('\n', text.size() / 10) + 1;
  text.replace(early, 3, "bad");
  const auto path = Write("events.txt", text);
  const events::Interval late{(events.t.back() - events.t.front()) / 2, {}};
  ExpectSame(ReadAll(path, late), Cut(events, late));
  Refusal([&] { ReadAll(path); });
}

TEST_F(TextEventsTest, NamesTheDurationForAnEmptyInterval) {
  const auto path = Write("events.txt", "1.5 1 1 0\n2 1 1 0\n4.25 1 1 1\n");
  for (const events::Interval& interval :
       {events::Interval{3 * kNsPerSecond, {}}, events::Interval{kNsPerSecond, kNsPerSecond},
        events::Interval{kNsPerSecond, 2 * kNsPerSecond}, events::Interval{9'000'000'000'000'000'000, {}}}) {
    const auto message = Refusal([&] { ReadAll(path, interval); }, ErrorKind::kNothingToDo);
    ExpectMentions(message, {path.string(), "2.750000000 s long", "--from"});
  }
}

TEST_F(TextEventsTest, RefusesABadLineAndNamesIt) {
  const std::string good = "0.1 1 1 0\n# comment\n0.2 2 2 1\n";
  const std::vector<std::string> lines = {"0.1234 12",         "0.1234 12 1", "0.1234 12 1 ", "0.3 1 1 2",
                                          "0.3 1 1 -",         "nan 1 1 1",   "inf 1 1 1",    "0.3 1.5 1 1",
                                          "0.3 1 1 1 1",       "0.3,1,1,1",   "0.3 x 1 1",    "0.3 1 1 11",
                                          "99999999999 1 1 1", "0.3s 1 1 1",  "0..3 1 1 1",   "0.3 1 1 0.5"};
  for (const auto& line : lines) {
    ExpectMentions(RefusalOf(good + line), {"bad.txt:4: "});
    ExpectMentions(RefusalOf(good + line + "\n0.4 1 1 1\n"), {"bad.txt:4: "});
  }
}

TEST_F(TextEventsTest, RefusesTimeThatRunsBackwards) {
  std::string text = ToText(MakeEvents(100'000, 0));
  text += "0.25 1 1 1\n";
  ExpectMentions(RefusalOf(text), {"bad.txt:100001: ", "backwards", "0.250000000 s", "sort"});
}

TEST_F(TextEventsTest, RefusesPixelsOffTheSensor) {
  for (const std::string line : {"0.3 346 0 1", "0.3 0 260 1", "0.3 -1 0 1", "0.3 70000 0 1"}) {
    ExpectMentions(
        RefusalOf("0.1 1 1 0\n" + line + "\n0.4 1 1 1\n"),
        {"bad.txt:2: ", "346 x 260", "give the calibration of this recording", line.substr(4, line.find(' ', 4) - 4)});
  }
}

TEST_F(TextEventsTest, RefusesFilesOfOtherKinds) {
  ExpectMentions(RefusalOf(""), {"bad.txt", "an empty file"});
  ExpectMentions(RefusalOf("# only\n\n# comments\n"), {"no events"});
  ExpectMentions(RefusalOf("\x89PNG\r\n\x1a\n...."), {"a PNG image"});
  ExpectMentions(RefusalOf(std::string("ab\0cd", 5)), {"a binary file"});
  ExpectMentions(RefusalOf("7 1468941032.255472635 31.5 46\n"), {"a track file"});
  ExpectMentions(RefusalOf("# id timestamp x y\n"), {"a track file"});
  ExpectMentions(RefusalOf("1.5 0 0 0 0 0 0 1\n"), {"a trajectory"});
  ExpectMentions(RefusalOf("cam0:\n  camera_model: pinhole\n"), {"a Kalibr calibration"});
  ExpectMentions(RefusalOf("hello world, this is prose\n"), {"bad.txt:1: ", "'t x y p'"});
  ExpectMentions(RefusalOf("0.1 1 1 1\n" + std::string(100'000, '7')), {"bad.txt:2: "});
}

TEST_F(TextEventsTest, FindsTheEventsOfAFolder) {
  ExpectMentions(Refusal([&] { ReadAll(folder); }), {folder.string(), "no events.txt"});
  Write("events.txt", "0.1 1 1 1\n");
  EXPECT_EQ(ReadAll(folder).size(), 1u);
  ExpectMentions(Refusal([&] { ReadAll(folder / "missing.txt"); }), {"missing.txt", "no such file"});
}

}  // namespace
}  // namespace evo::io
