#include <gtest/gtest.h>

#include <algorithm>

#include "evo/io/calibration_io.hpp"
#include "evo/io/open_events.hpp"
#include "evo/io/sequence.hpp"
#include "evo/io/track_io.hpp"
#include "evo/io/trajectory_io.hpp"
#include "io/support.hpp"

namespace evo::io {
namespace {

/// Real and simulated recordings that are not part of the project.
class SamplesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not there";
  }
  const std::filesystem::path data = kShared / "data";
};

TEST_F(SamplesTest, Street) {
  const SequenceFiles files = FindSequence(data / "street_12s");
  ASSERT_TRUE(files.calibration && files.ground_truth);
  const geometry::Calibration calibration = ReadCalibration(*files.calibration);
  const auto reader = OpenEvents(files.events, {}, calibration.width, calibration.height);
  events::EventColumns block;
  std::size_t events = 0;
  TimeNs last = 0;
  while (reader->Next(&block)) {
    events += block.size();
    last = block.t.back();
  }
  EXPECT_EQ(events, 15'053'249u);
  EXPECT_NEAR(ToSeconds(last - reader->first_stamp()), 12.0, 1e-3);
  const geometry::Trajectory truth = ReadGroundTruth(*files.ground_truth, GroundTruthSource::kLoam);
  EXPECT_EQ(truth.size(), 241u);
  EXPECT_EQ(ReadGroundTruth(*files.ground_truth, GroundTruthSource::kCartographer).size(), 241u);
}

TEST_F(SamplesTest, StreetIntervalEqualsACut) {
  const auto path = data / "street_12s" / "street_data.hdf5";
  const events::Interval start{0, 300'000'000};
  const events::Interval part{100'000'000, 250'000'000};
  ExpectSame(ReadAll(path, part), Cut(ReadAll(path, start), part));
}

TEST_F(SamplesTest, UzhSlider) {
  const auto folder = data / "uzh_slider_depth";
  const events::EventColumns events = ReadAll(folder / "events_chunk.txt", {}, 240, 180);
  EXPECT_EQ(events.size(), 50'000u);
  EXPECT_EQ(events.t.front(), 3'811'000);
  EXPECT_EQ(ReadTum(folder / "groundtruth.txt").size(), 339u);
  EXPECT_EQ(ReadCalibration(folder / "calib.txt").width, 240);
  ExpectMentions(Refusal([&] { ReadAll(folder / "images.txt"); }), {"images.txt:1: "});
}

TEST_F(SamplesTest, UzhBoxesTracks) {
  const auto folder = data / "uzh_boxes_6dof_tracks";
  const events::Tracks tracks = ReadTracks(folder / "tracks.txt");
  EXPECT_EQ(tracks.size(), 52'435u);
  EXPECT_TRUE(std::ranges::is_sorted(tracks, {}, &events::TrackObservation::t));
  EXPECT_EQ(ReadGroundTruth(folder / "groundtruth.txt", GroundTruthSource::kLoam).size(), 11'954u);
  ExpectMentions(Refusal([&] { ReadAll(folder / "tracks.txt"); }), {"a track file"});
}

TEST_F(SamplesTest, EvbenchAndIndoorFlying) {
  EXPECT_EQ(ReadAll(data / "evbench_seq2", {}, 240, 180).size(), 273'143u);
  const auto folder = data / "mvsec_indoor_flying";
  EXPECT_EQ(ReadCalibration(folder / "camchain-imucam-indoor_flying.yaml").height, 260);
  EXPECT_EQ(ReadTum(folder / "indoor_flying1_groundtruth_tum.txt").size(), 5695u);
}

}  // namespace
}  // namespace evo::io
