#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "evo/io/mvsec_writer.hpp"
#include "evo/io/open_events.hpp"
#include "io/hdf5_support.hpp"
#include "io/support.hpp"

namespace evo::io {
namespace {

constexpr TimeNs kEpoch = 1506117912'000000000;

class MvsecEventsTest : public IoTest {
 protected:
  std::string RefusalOf(const std::vector<double>& rows, const Storage& storage = {}) const {
    const auto path = folder / "bad.hdf5";
    std::filesystem::remove(path);
    StoreEvents(path, rows, storage);
    return Refusal([&] { ReadAll(path); });
  }
};

TEST_F(MvsecEventsTest, ReadsWhatItWritesToTheResolutionOfADouble) {
  const events::EventColumns events = MakeEvents(150'000, kEpoch);
  const auto path = folder / "out" / "a_data.hdf5";
  WriteMvsecEvents(path, events);
  events::EventColumns read = ReadAll(path);
  ASSERT_EQ(read.size(), events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    ASSERT_LE(std::abs(read.t[i] - events.t[i]), 120) << i;
    read.t[i] = events.t[i];
  }
  ExpectSame(read, events);
}

TEST_F(MvsecEventsTest, WritesTheSameBytesInPieces) {
  const events::EventColumns events = MakeEvents(70'000, 0);
  WriteMvsecEvents(folder / "whole.hdf5", events);
  {
    MvsecDataWriter writer(folder / "pieces.hdf5");
    events::EventColumns piece;
    for (std::size_t i = 0; i < events.size(); ++i) {
      piece.push_back(events.t[i], events.x[i], events.y[i], events.polarity[i]);
      if (piece.size() == 999 || i + 1 == events.size()) {
        writer.Append(piece);
        piece.clear();
      }
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "pieces.hdf5"));
    writer.Commit();
  }
  ExpectSame(ReadAll(folder / "pieces.hdf5"), ReadAll(folder / "whole.hdf5"));
  { MvsecDataWriter(folder / "never.hdf5").Append(events); }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 2);
}

TEST_F(MvsecEventsTest, ReadsEveryLayout) {
  const events::EventColumns events = MakeEvents(30'000, 0);
  const std::vector<double> rows = EventRows(events);
  const std::vector<Storage> storages = {{H5T_NATIVE_DOUBLE, {}, false},         {H5T_NATIVE_DOUBLE, {1024, 4}, true},
                                         {H5T_NATIVE_DOUBLE, {777, 1}, true},    {H5T_NATIVE_DOUBLE, {30'000, 4}, true},
                                         {H5T_NATIVE_DOUBLE, {64, 4}, false},    {H5T_IEEE_F64BE, {5000, 2}, true},
                                         {H5T_NATIVE_LDOUBLE, {1000, 4}, false}, {H5T_NATIVE_DOUBLE, {777, 1}, false},
                                         {H5T_NATIVE_DOUBLE, {1000, 3}, true},   {H5T_NATIVE_DOUBLE, {5000, 2}, false}};
  for (std::size_t i = 0; i < storages.size(); ++i) {
    const auto path = folder / (std::to_string(i) + ".hdf5");
    StoreEvents(path, rows, storages[i]);
    ExpectSame(ReadAll(path), events);
    const events::Interval middle{(events.t.back() - events.t[0]) / 3, (events.t.back() - events.t[0]) / 2};
    ExpectSame(ReadAll(path, middle), Cut(events, middle));
  }
}

TEST_F(MvsecEventsTest, BlocksAreWholeChunksAndBounded) {
  const events::EventColumns events = MakeEvents(300'000, 0);
  const auto path = folder / "a.hdf5";
  StoreEvents(path, EventRows(events), {H5T_NATIVE_DOUBLE, {30'000, 4}, false});
  const auto reader = OpenEvents(path, {events.t[1000] - events.t[0], {}}, 346, 260);
  events::EventColumns block;
  ASSERT_TRUE(reader->Next(&block));
  EXPECT_EQ(block.t.back(), events.t[89'999]);
  ASSERT_TRUE(reader->Next(&block));
  EXPECT_EQ(block.size(), 90'000u);
  EXPECT_EQ(reader->first_stamp(), events.t[0]);
  EXPECT_EQ(reader->last_stamp(), events.t.back());

  const auto large = folder / "large.hdf5";
  StoreEvents(large, EventRows(events), {H5T_NATIVE_DOUBLE, {300'000, 4}, true});
  ExpectSame(ReadAll(large), events);
}

TEST_F(MvsecEventsTest, IntervalsEqualACutOfTheWholeFile) {
  const events::EventColumns events = MakeEvents(20'000, 0);
  const auto path = folder / "a.hdf5";
  StoreEvents(path, EventRows(events), {H5T_NATIVE_DOUBLE, {512, 4}, true});
  const TimeNs length = events.t.back();
  for (int i = 0; i < 30; ++i) {
    for (const TimeNs duration : {TimeNs{1000}, length / 7, length}) {
      const events::Interval interval{length * i / 31, length * i / 31 + duration};
      const events::EventColumns expected = Cut(events, interval);
      if (!expected.empty()) ExpectSame(ReadAll(path, interval), expected);
    }
    const events::Interval exact{events.t[600u * static_cast<unsigned>(i)], {}};
    ExpectSame(ReadAll(path, exact), Cut(events, exact));
  }
}

TEST_F(MvsecEventsTest, IntervalReadsNothingBeforeIt) {
  const events::EventColumns events = MakeEvents(20'000, 0);
  std::vector<double> rows = EventRows(events);
  rows[4 * 100] = 1e6;
  const auto path = folder / "a.hdf5";
  StoreEvents(path, rows);
  const events::Interval late{events.t.back() / 2, {}};
  ExpectSame(ReadAll(path, late), Cut(events, late));
}

TEST_F(MvsecEventsTest, NamesTheDurationForAnEmptyInterval) {
  const auto path = folder / "a.hdf5";
  StoreEvents(path, {1, 1, 100.5, 1, 1, 1, 103, -1});
  for (const events::Interval& interval :
       {events::Interval{3 * kNsPerSecond, {}}, events::Interval{kNsPerSecond, 2 * kNsPerSecond}}) {
    ExpectMentions(Refusal([&] { ReadAll(path, interval); }, ErrorKind::kNothingToDo),
                   {path.string(), "2.500000000 s long"});
  }
}

TEST_F(MvsecEventsTest, ReadsFloat32AndIntegersWithPreciseStampsOnly) {
  const events::EventColumns events = MakeEvents(1000, kEpoch);
  StoreEvents(folder / "us.hdf5", EventRows(events, 1000), {H5T_NATIVE_INT64, {}, false});
  ExpectSame(ReadAll(folder / "us.hdf5"), events);
  StoreEvents(folder / "ns.hdf5", EventRows(events, 1), {H5T_NATIVE_INT64, {}, false});
  const events::EventColumns ns = ReadAll(folder / "ns.hdf5");
  ASSERT_EQ(ns.size(), events.size());
  for (std::size_t i = 0; i < ns.size(); ++i) ASSERT_LE(std::abs(ns.t[i] - events.t[i]), 128);

  const std::vector<double> from_zero = {1, 2, 0.5, 1, 3, 4, 0.75, -1};
  StoreEvents(folder / "float.hdf5", from_zero, {H5T_NATIVE_FLOAT, {}, false});
  EXPECT_EQ(ReadAll(folder / "float.hdf5").t, (std::vector<TimeNs>{500'000'000, 750'000'000}));
  ExpectMentions(RefusalOf(EventRows(events), {H5T_NATIVE_FLOAT, {}, false}), {"float32", "128 s", "float64"});
  ExpectMentions(RefusalOf({1, 2, 1000, 1, 3, 4, 2000, 0}, {H5T_NATIVE_INT32, {}, false}),
                 {"davis/left/events", "integers", "1000", "float64 seconds"});
}

TEST_F(MvsecEventsTest, ReadsZeroAsDarker) {
  StoreEvents(folder / "a.hdf5", {1, 2, 0.5, 0, 3, 4, 0.75, 1, 3, 4, 0.75, -1});
  EXPECT_EQ(ReadAll(folder / "a.hdf5").polarity, (std::vector<std::int8_t>{-1, 1, -1}));
}

TEST_F(MvsecEventsTest, RefusesABadRowAndNamesIt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<std::vector<double>, std::vector<std::string>>> cases = {
      {{1, 1, nan, 1}, {"the stamp nan"}},
      {{1, 1, inf, 1}, {"the stamp inf"}},
      {{1, 1, 1e12, 1}, {"not a time"}},
      {{nan, 1, 3, 1}, {"nan"}},
      {{1, inf, 3, 1}, {"inf"}},
      {{1.5, 1, 3, 1}, {"1.5", "not whole"}},
      {{346, 1, 3, 1}, {"(346, 1)", "346 x 260", "give the calibration of this recording"}},
      {{1, 260, 3, 1}, {"(1, 260)"}},
      {{-1, 0, 3, 1}, {"(-1, 0)"}},
      {{1, 1, 3, 2}, {"polarity 2"}},
      {{1, 1, 3, nan}, {"polarity nan"}},
      {{1, 1, 0.5, 1}, {"backwards", "1.000000000 s", "0.500000000 s", "sort"}},
  };
  for (const auto& [row, parts] : cases) {
    std::vector<double> rows;
    for (int i = 0; i < 100; ++i) rows.insert(rows.end(), {1, 1, 0.01 * (i + 1), -1});
    rows.insert(rows.end(), row.begin(), row.end());
    rows.insert(rows.end(), {1, 1, 4, 1});
    const std::string message = RefusalOf(rows);
    ExpectMentions(message, {"bad.hdf5: davis/left/events row 100: "});
    ExpectMentions(message, parts);
  }
}

TEST_F(MvsecEventsTest, RefusesTimeThatRunsBackwardsBetweenBlocks) {
  std::vector<double> rows;
  for (int i = 0; i < 65'536; ++i) rows.insert(rows.end(), {1, 1, 10.0, 1});
  rows.insert(rows.end(), {1, 1, 9.0, 1});
  ExpectMentions(RefusalOf(rows), {"row 65536", "backwards"});
}

TEST_F(MvsecEventsTest, RefusesOtherShapesAndMissingDataSets) {
  const auto path = folder / "a.hdf5";
  StoreTable(path, "davis/left/imu", {2, 6}, std::vector<double>(12, 0.0));
  StoreTable(path, "davis/right/events", {1, 4}, {1, 1, 1, 1});
  ExpectMentions(Refusal([&] { ReadAll(path); }),
                 {path.string(), "no data set davis/left/events", "davis/left/imu, davis/right/events"});
  StoreTable(path, "davis/left/events", {3, 5}, std::vector<double>(15, 1.0));
  ExpectMentions(Refusal([&] { ReadAll(path); }), {"davis/left/events", "3 x 5", "N x 4"});
  StoreTable(folder / "flat.hdf5", "davis/left/events", {4}, {1, 1, 1, 1});
  ExpectMentions(Refusal([&] { ReadAll(folder / "flat.hdf5"); }), {"shape 4;"});
  StoreTable(folder / "none.hdf5", "davis/left/events", {0, 4}, {}, {H5T_NATIVE_DOUBLE, {16, 4}, false});
  ExpectMentions(Refusal([&] { ReadAll(folder / "none.hdf5"); }), {"holds no events"});
}

TEST_F(MvsecEventsTest, RefusesAFileCutShort) {
  const auto path = folder / "cut.hdf5";
  WriteMvsecEvents(path, MakeEvents(50'000, 0));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  ExpectMentions(Refusal([&] { ReadAll(path); }), {path.string(), "truncated file"});
}

TEST_F(MvsecEventsTest, RefusesADamagedChunk) {
  const auto path = folder / "damaged.hdf5";
  StoreEvents(path, EventRows(MakeEvents(50'000, 0)), {H5T_NATIVE_DOUBLE, {50'000, 4}, true});
  std::string bytes = Content(path);
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 2000; ++i) bytes[i] = '\x55';
  Write("damaged.hdf5", bytes);
  ExpectMentions(Refusal([&] { ReadAll(path); }), {path.string(), "davis/left/events"});
}

/// One chunk of two events, stored through `filter` as the bytes `stream`.
void StoreFiltered(const std::filesystem::path& path, H5Z_filter_t filter, const std::vector<unsigned char>& stream) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5Zunregister(filter);  // HDF5 writes no data set through a filter that it knows to be unable to encode
  const std::vector<hsize_t> shape = {2, 4};
  const std::vector<unsigned> parameters = {4, 261, 64};
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(creation, 2, shape.data());
  H5Pset_filter(creation, filter, H5Z_FLAG_OPTIONAL, parameters.size(), parameters.data());
  const hid_t space = H5Screate_simple(2, shape.data(), nullptr);
  const hid_t events = H5Dcreate2(file, "davis/left/events", H5T_IEEE_F64LE, space, links, creation, H5P_DEFAULT);
  const hsize_t offset[] = {0, 0};
  ASSERT_GE(H5Dwrite_chunk(events, H5P_DEFAULT, 0, offset, stream.size(), stream.data()), 0);
  H5Dclose(events);
  H5Sclose(space);
  H5Pclose(creation);
  H5Pclose(links);
  H5Fclose(file);
}

TEST_F(MvsecEventsTest, NamesAFilterThatIsNotInstalled) {
  const auto path = folder / "a.hdf5";
  StoreFiltered(path, 399, std::vector<unsigned char>(64, 0));
  ExpectMentions(Refusal([&] { ReadAll(path); }), {"davis/left/events", "filter 399", "HDF5_PLUGIN_PATH"});
}

TEST_F(MvsecEventsTest, ReadsLzfAndRefusesDamagedStreams) {
  // Two events (2, 2, 2.0, 1): as doubles 00*7 40 three times, 00*6 f0 3f, then all of it once more.
  const std::vector<unsigned char> stream = {
      7,    0,    0,    0, 0, 0, 0, 0, 0x40,  // eight literals
      0xe0, 7,    7,                          // sixteen bytes from eight back
      0,    0,    0x60, 0,                    // a zero, five bytes from one back
      1,    0xf0, 0x3f,                       // two literals
      0xe0, 23,   31,                         // 32 bytes from 32 back
  };
  StoreFiltered(folder / "a.hdf5", 32000, stream);
  const events::EventColumns events = ReadAll(folder / "a.hdf5");
  EXPECT_EQ(events.t, (std::vector<TimeNs>{2 * kNsPerSecond, 2 * kNsPerSecond}));
  EXPECT_EQ(events.x, (std::vector<std::uint16_t>{2, 2}));
  EXPECT_EQ(events.polarity, (std::vector<std::int8_t>{1, 1}));
  for (const std::vector<unsigned char>& broken : {std::vector<unsigned char>{7, 0},
                                                   {0xe0},
                                                   {0xe0, 1},
                                                   {0, 0, 0x20, 9},
                                                   {0, 0},
                                                   {0xe0, 255, 0},
                                                   {0, 0, 0xe0, 255, 0}}) {
    StoreFiltered(folder / "b.hdf5", 32000, broken);
    ExpectMentions(Refusal([&] { ReadAll(folder / "b.hdf5"); }), {"b.hdf5: davis/left/events"});
  }
}

TEST_F(MvsecEventsTest, DetectsHdf5ByContent) {
  WriteMvsecEvents(folder / "events.txt", MakeEvents(10, 0));
  EXPECT_EQ(ReadAll(folder / "events.txt").size(), 10u);
  Write("text.hdf5", "0.1 1 1 1\n");
  EXPECT_EQ(ReadAll(folder / "text.hdf5").size(), 1u);
}

TEST_F(MvsecEventsTest, NamesThePathThatCannotBeWritten) {
  Write("file", "x");
  EXPECT_NE(Refusal([&] { WriteMvsecEvents(folder / "file" / "a.hdf5", MakeEvents(1, 0)); }, ErrorKind::kOutput), "");
}

}  // namespace
}  // namespace evo::io
