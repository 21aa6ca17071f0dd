#include "evo/io/track_io.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "io/support.hpp"

namespace evo::io {
namespace {

class TracksTest : public IoTest {
 protected:
  std::string RefusalOf(const std::string& text) const {
    const auto path = Write("bad.txt", text);
    return Refusal([&] { ReadTracks(path); });
  }
};

TEST_F(TracksTest, ReadsWhatItWrites) {
  const events::Tracks tracks = {{0, 1506117912'000000001, 1.25, 2.5},
                                 {7, 1506117912'000000001, 345.0001, -0.5},
                                 {0, 1506117912'020000000, 1.5, 2.75}};
  WriteTracks(folder / "out" / "tracks.txt", tracks, {"reference instant: middle of the window"});
  EXPECT_EQ(Content(folder / "out" / "tracks.txt"),
            "# id timestamp x y\n"
            "# reference instant: middle of the window\n"
            "0 1506117912.000000001 1.2500 2.5000\n"
            "7 1506117912.000000001 345.0001 -0.5000\n"
            "0 1506117912.020000000 1.5000 2.7500\n");
  EXPECT_TRUE(ReadTracks(folder / "out" / "tracks.txt") == tracks);
}

TEST_F(TracksTest, WritesTheSameBytesInPieces) {
  const events::Tracks tracks = {
      {0, kNsPerSecond, 1.25, 2.5}, {7, kNsPerSecond, 3, 4}, {0, 2 * kNsPerSecond, 1.5, 2.75}};
  WriteTracks(folder / "whole.txt", tracks, {"a comment"});
  {
    TrackWriter writer(folder / "parts.txt", {"a comment"});
    writer.Write(std::span(tracks).first(2));
    writer.Write({});
    writer.Write(std::span(tracks).subspan(2));
    EXPECT_FALSE(std::filesystem::exists(folder / "parts.txt"));
    writer.Commit();
    TrackWriter abandoned(folder / "abandoned.txt");
    abandoned.Write(tracks);
  }
  EXPECT_EQ(Content(folder / "parts.txt"), Content(folder / "whole.txt"));
  EXPECT_FALSE(std::filesystem::exists(folder / "abandoned.txt"));
}

TEST_F(TracksTest, RoundedTracksEqualThoseOfTheFile) {
  events::Tracks tracks;
  for (int i = 0; i < 20000; ++i) tracks.push_back({i, kNsPerSecond, 345.0 * i / 20000.0 + 1e-5, 0.00005 * i});
  RoundAsWritten(&tracks);
  WriteTracks(folder / "tracks.txt", tracks);
  EXPECT_TRUE(ReadTracks(folder / "tracks.txt") == tracks);
}

TEST_F(TracksTest, SortsAsynchronousRowsByTimeThenId) {
  const events::Tracks expected = {
      {0, 500'000'000, 1, 1}, {1, 500'000'000, 3, 3}, {1, 600'000'000, 5, 5}, {0, 700'000'000, 2, 2}};
  const auto path = Write("tracks.txt", "0 0.5 1 1\n0 0.7 2 2\n1 0.6 5 5\n1 0.5 3 3\n");
  EXPECT_TRUE(ReadTracks(path) == expected);
}

TEST_F(TracksTest, ReadsHasteAndNumpyIds) {
  const events::Tracks expected = {{3, 500'000'000, 10.5, 20.25}, {4, 600'000'000, 1, 2}};
  EXPECT_TRUE(ReadTracks(Write("haste.csv", "0.6,1,2,0.1,4\n0.5,10.5,20.25,-0.3,3\r\n")) == expected);
  EXPECT_TRUE(ReadTracks(Write("numpy.txt", "3.0 0.5 10.5 20.25\n4e0 6e-1 1.0 2.0\n")) == expected);
}

TEST_F(TracksTest, KeepsOneObservationForEachIdAndStamp) {
  const auto same = Write("same.txt", "1 0.5 2 3\n2 0.5 9 9\n1 0.5 2 3\n");
  EXPECT_TRUE(ReadTracks(same) == (events::Tracks{{1, 500'000'000, 2, 3}, {2, 500'000'000, 9, 9}}));
  const auto haste = Write("haste.csv", "0.5,2,3,0,1\n0.5,2.5,3,0,1\n");
  EXPECT_TRUE(ReadTracks(haste) == (events::Tracks{{1, 500'000'000, 2.5, 3}}));
  ExpectMentions(RefusalOf("1 0.5 2 3\n2 0.5 9 9\n1 0.5 2.5 3\n"),
                 {"bad.txt:3: ", "track 1", "0.500000000 s", "line 1"});
}

TEST_F(TracksTest, RefusesABadRowAndNamesIt) {
  const std::string good = "# id timestamp x y\n1 0.5 2 3\n";
  for (const std::string row : {"2 0.5 2", "2 0.5 2 3 4", "-1 0.5 2 3", "1.5 0.5 2 3", "x 0.5 2 3", "2 nan 2 3",
                                "2 0.5 inf 3", "2 0.5 2 nan", "2 0.5 2 y", "0.5,2,3,0,1"}) {
    ExpectMentions(RefusalOf(good + row + "\n"), {"bad.txt:3: "});
  }
  ExpectMentions(RefusalOf("0.5,2,3,0,1\n0.6,2,3,0\n"), {"bad.txt:2: ", "t,x,y,theta,id"});
  ExpectMentions(RefusalOf("# id timestamp x y\n"), {"no tracks"});
}

TEST_F(TracksTest, RefusesOtherFiles) {
  ExpectMentions(RefusalOf(""), {"an empty file", "a track file"});
  ExpectMentions(RefusalOf("1.0 0 0 0 0 0 0 1\n"), {"a trajectory text"});
  ExpectMentions(RefusalOf("0.000000 27 70 1\n0.000829 27 69 1\n"), {"bad.txt:2: ", "0.000829"});
  ExpectMentions(Refusal([&] { ReadTracks(folder / "none"); }), {"no such file"});
}

TEST_F(TracksTest, RefusesToWriteWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ExpectMentions(Refusal([&] { WriteTracks(folder / "a.txt", {{3, kNsPerSecond, 1, nan}}); }), {"a.txt", "track 3"});
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

}  // namespace
}  // namespace evo::io
