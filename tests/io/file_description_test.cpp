#include "evo/io/file_description.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "evo/io/checksum.hpp"
#include "evo/io/file_kind.hpp"
#include "evo/io/mvsec_writer.hpp"
#include "evo/io/sequence.hpp"
#include "io/hdf5_support.hpp"
#include "io/support.hpp"

namespace evo::io {
namespace {

class FileDescriptionTest : public IoTest {
 protected:
  std::map<std::string, std::string> Values(const std::filesystem::path& path, const std::string& kind) const {
    const FileDescription description = DescribeFile(path);
    EXPECT_EQ(description.kind, kind);
    return {description.values.begin(), description.values.end()};
  }
};

using ChecksumTest = IoTest;
using SequenceTest = IoTest;
using FileKindTest = IoTest;

TEST_F(FileDescriptionTest, CountsTextEventsExactly) {
  auto values = Values(Write("events.txt", "1.5 3 7 1\n2.0 30 4 0\n3.5 9 5 0\n4 3 4 0\n"), "UZH events");
  EXPECT_EQ(values["events"], "4");
  EXPECT_EQ(values["first stamp"], "1.500000000 s");
  EXPECT_EQ(values["last stamp"], "4.000000000 s");
  EXPECT_EQ(values["duration"], "2.500000000 s");
  EXPECT_EQ(values["mean rate"], "1.2 events/s");
  EXPECT_EQ(values["columns"], "3 to 30 px");
  EXPECT_EQ(values["rows"], "4 to 7 px");
  EXPECT_EQ(values["positive"], "25.0 %");
}

TEST_F(FileDescriptionTest, SamplesMvsecEvents) {
  const events::EventColumns events = MakeEvents(100'000, 0);
  WriteMvsecEvents(folder / "a.hdf5", events);
  auto values = Values(folder / "a.hdf5", "MVSEC events");
  EXPECT_EQ(values["events"], "100000");
  EXPECT_EQ(values["last stamp"], FormatTime(events.t.back()) + " s");
  EXPECT_EQ(values["columns"], "0 to 345 px (from samples)");
  WriteMvsecEvents(folder / "one.hdf5", MakeEvents(1, 0));
  EXPECT_EQ(Values(folder / "one.hdf5", "MVSEC events")["duration"], "0.000000000 s");
}

TEST_F(FileDescriptionTest, MeasuresTrajectories) {
  const auto path = Write("a.txt", "1 0 0 0 0 0 0 1\n2 3 0 4 0 0 0 1\n3 3 1 4 0 0 0 1\n");
  auto values = Values(path, "trajectory");
  EXPECT_EQ(values["poses"], "3");
  EXPECT_EQ(values["path length"], "6.000 m");
  EXPECT_EQ(values["mean rate"], "1.0 poses/s");
  WriteMvsecGroundTruth(folder / "a_gt.hdf5", {{0, {}}}, {{0, {}}, {kNsPerSecond, {}}});
  auto truth = Values(folder / "a_gt.hdf5", "MVSEC ground truth");
  EXPECT_EQ(truth["odometry (loam) poses"], "1");
  EXPECT_EQ(truth["pose (cartographer) poses"], "2");
}

TEST_F(FileDescriptionTest, CountsDepthMaps) {
  MvsecGroundTruthWriter writer(folder / "a_gt.hdf5", {{0, {}}}, {{0, {}}});
  for (const TimeNs t : {kNsPerSecond, kNsPerSecond * 3 / 2}) writer.AppendDepth(t, {3, 2, std::vector(6, 1.0)});
  writer.Commit();
  auto truth = Values(folder / "a_gt.hdf5", "MVSEC ground truth");
  EXPECT_EQ(truth["depth maps"], "2 of 3 x 2 px");
  EXPECT_EQ(truth["depth maps first stamp"], "1.000000000 s");
  EXPECT_EQ(truth["depth maps mean rate"], "2.0 maps/s");
  StoreTable(folder / "depth_gt.hdf5", "davis/left/depth_image_raw", {1, 2, 3}, {1, 1, 1, 1, 1, 1});
  ExpectMentions(Refusal([&] { DescribeFile(folder / "depth_gt.hdf5"); }), {"depth_image_raw_ts"});
}

TEST_F(FileDescriptionTest, MeasuresTracks) {
  auto values = Values(Write("t.txt", "# id timestamp x y\n0 1.0 1 1\n4 1.0 2 2\n0 1.5 1 1\n0 3.0 1 1\n"), "tracks");
  EXPECT_EQ(values["tracks"], "2");
  EXPECT_EQ(values["observations"], "4");
  EXPECT_EQ(values["mean lifetime"], "1.000 s");
  EXPECT_EQ(values["longest lifetime"], "2.000 s");
  EXPECT_EQ(values["mean observations a track"], "2.0");
}

TEST_F(FileDescriptionTest, ShowsCalibrationsAndFolders) {
  const auto path = Write("seq/calib.txt", "199.5 198 132 110 -0.368 0.15 0 0 0\n");
  auto values = Values(path, "calibration");
  EXPECT_EQ(values["focal lengths"], "199.5 198 px");
  EXPECT_EQ(values["sensor"], "240 x 180 px (assumed, the file does not say)");
  EXPECT_EQ(values["coefficients"], "-0.368 0.15 0 0 0");
  Write("seq/events.txt", "1.5 3 7 1\n");
  auto sequence = Values(folder / "seq", "UZH events");
  EXPECT_EQ(sequence["events"], "1");
  EXPECT_EQ(sequence["calibration file"], path.string());
  EXPECT_EQ(sequence["ground truth file"], "none");
}

TEST_F(FileDescriptionTest, RefusesUnknownKinds) {
  ExpectMentions(Refusal([&] { DescribeFile(Write("a.txt", "some prose\n")); }), {"a.txt", "a text of unknown kind"});
  ExpectMentions(Refusal([&] { DescribeFile(Write("a.png", "\x89PNG\r\n\x1a\n")); }), {"a PNG image"});
  StoreTable(folder / "a.hdf5", "davis/right/events", {1, 4}, {1, 1, 1, 1});
  ExpectMentions(Refusal([&] { DescribeFile(folder / "a.hdf5"); }), {"davis/right/events"});
  ExpectMentions(Refusal([&] { DescribeFile(folder / "none"); }), {"no such file"});
}

TEST_F(ChecksumTest, IsSha256) {  // the values of FIPS 180-4's examples
  EXPECT_EQ(Sha256(Write("abc", "abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256(Write("empty", "")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256(Write("million", std::string(1'000'000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  ExpectMentions(Refusal([&] { Sha256(folder / "none"); }), {"none"});
  ExpectMentions(Refusal([&] { Sha256(folder); }), {"not a regular file"});
}

TEST_F(SequenceTest, FindsTheFilesOfAUzhFolder) {
  Write("seq/events.txt", "");
  Write("seq/groundtruth.txt", "");
  SequenceFiles files = FindSequence(folder / "seq");
  EXPECT_EQ(files.events, folder / "seq" / "events.txt");
  EXPECT_FALSE(files.calibration);
  EXPECT_EQ(files.ground_truth, folder / "seq" / "groundtruth.txt");
  files = FindSequence(folder / "seq" / "events.txt");
  EXPECT_FALSE(files.ground_truth);
}

TEST_F(SequenceTest, FindsTheFilesOfAnMvsecFolder) {
  for (const char* name : {"day_data.hdf5", "day_gt.hdf5", "camchain-imucam-day.yaml"}) Write(name, "x");
  const SequenceFiles files = FindSequence(folder);
  EXPECT_EQ(files.events, folder / "day_data.hdf5");
  EXPECT_EQ(files.calibration, folder / "camchain-imucam-day.yaml");
  EXPECT_EQ(files.ground_truth, folder / "day_gt.hdf5");
  Write("night_data.hdf5", "x");
  ExpectMentions(Refusal([&] { FindSequence(folder); }), {"more than one", "name the event file"});
  ExpectMentions(Refusal([&] { FindSequence(folder / "none"); }), {"no such file"});
}

TEST_F(FileKindTest, DetectsTheKindByContent) {
  EXPECT_EQ(DetectKind(Write("a", "0.003811000 96 133 0\n")), FileKind::kEventText);
  EXPECT_EQ(DetectKind(Write("a", "# comment\r\n\r\n0.003811000 96 133 -1\r\n")), FileKind::kEventText);
  EXPECT_EQ(DetectKind(Write("a", "0 1468941032.255472635 31 46\n")), FileKind::kTrackText);
  EXPECT_EQ(DetectKind(Write("a", "1.5,10,20,0.1,7\n")), FileKind::kTrackText);
  EXPECT_EQ(DetectKind(Write("a", "# id timestamp x y\n1 5 6 1\n")), FileKind::kTrackText);
  EXPECT_EQ(DetectKind(Write("a", "0.02 0.1 0.0 0.0 0.0 0.0 0.0 1.0\n")), FileKind::kTrajectoryText);
  EXPECT_EQ(DetectKind(Write("k", "1 0 0 0 0 1 0 0 0 0 1 0\n")), FileKind::kKittiPoses);
  EXPECT_EQ(DetectKind(Write("a", "199 198 132 110 -0.3 0.1 0 0 0\n")), FileKind::kCalibrationText);
  EXPECT_EQ(DetectKind(Write("a", "# chain\nT_x:\n- [1]\ncam0:\n  a: b\n")), FileKind::kCalibrationYaml);
  EXPECT_EQ(DetectKind(Write("a", "a,b\n")), FileKind::kOtherText);
  EXPECT_EQ(DetectKind(Write("a", "0.1 5\n")), FileKind::kOtherText);
  EXPECT_EQ(DetectKind(Write("a", "\x01\x02")), FileKind::kBinary);
  EXPECT_EQ(DetectKind(Write("a", "")), FileKind::kEmpty);
  EXPECT_EQ(DetectKind(folder), FileKind::kFolder);
}

}  // namespace
}  // namespace evo::io
