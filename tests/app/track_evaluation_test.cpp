// evo-run evaluate --tracks: from track files and truth to the tables.
#include <map>
#include <sstream>
#include <vector>

#include "app/evo_run.hpp"
#include "evaluation/track_scene.hpp"
#include "evo/io/track_io.hpp"
#include "evo/io/trajectory_io.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

constexpr char kPlainCalibration[] =
    "cam0:\n  camera_model: pinhole\n  intrinsics: [100, 100, 100, 75]\n  distortion_model: radtan\n"
    "  distortion_coeffs: [0, 0, 0, 0]\n  resolution: [201, 151]\n";

class TrackEvaluationTest : public EvoRunTest {
 protected:
  std::string To(const std::string& result) const { return " --no-plots --out " + Quote(folder / result); }

  /// Values of track_quality.csv by "quantity threshold_px", error over age left out.
  std::map<std::string, std::string> Quality(const std::string& result) const {
    std::istringstream csv(ReadFile(folder / result / "track_quality.csv"));
    std::map<std::string, std::string> values;
    for (std::string line; std::getline(csv, line);) {
      std::vector<std::string> cells;
      std::istringstream stream(line);
      for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
      if (cells.size() == 6 && cells[3].empty())
        values[cells[0] + ' ' + cells[2].substr(0, cells[2].find('.'))] = cells[5];
    }
    return values;
  }

  /// Follows features of a bundled sequence and judges them by its depth maps.
  std::map<std::string, std::string> JudgeTracks(const std::string& sequence, const std::string& truth,
                                                 const std::string& calibration) {
    const fs::path sample = BundledSequence(sequence);
    EXPECT_EQ(Run("track -q --events " + Quote(sample) + To("tracks")), 0) << err;
    EXPECT_EQ(Run("evaluate --tracks " + Quote(folder / "tracks" / "tracks.txt") + " --ground-truth " +
                  Quote(sample / truth) + " --calibration " + Quote(sample / calibration) + To("quality")),
              0)
        << err;
    return Quality("quality");
  }

  struct Bounds {
    double judged = 0.0;          ///< tracks
    double track_error_px = 0.0;  ///< median over the tracks of the mean error
    double outlier_share = 0.0;   ///< of 5 px
    double age_share = 0.0;       ///< expected feature age within 5 px over the time that the point is visible
  };

  static void ExpectQuality(const std::map<std::string, std::string>& quality, const Bounds& bounds) {
    EXPECT_EQ(quality.at("truth "), "depth");
    EXPECT_GT(std::stod(quality.at("tracks_judged ")), bounds.judged);
    EXPECT_LT(std::stod(quality.at("track_error_median ")), bounds.track_error_px);
    EXPECT_LT(std::stod(quality.at("outlier_share 5")), bounds.outlier_share);
    EXPECT_GT(std::stod(quality.at("expected_feature_age_normalized 5")), bounds.age_share);
  }

  /// A drive along a wall with tracks that are right but for `offset_px` from their second observation on.
  std::string SceneArguments(double offset_px, bool with_depth = true) const {
    const evaluation::testing::TrackScene scene;
    if (with_depth) {
      scene.WriteGroundTruth(folder / "wall_gt.hdf5");
    } else {
      io::WriteMvsecGroundTruth(folder / "wall_gt.hdf5", scene.Poses(), scene.Poses());
    }
    events::Tracks all;
    for (int id = 0; id < 12; ++id) {
      events::Tracks track = scene.Follow(id, {60.0 + 10.0 * id, 20.0 + 9.0 * id}, 0.013 * id, 1.0);
      for (std::size_t i = 1; i < track.size(); ++i) track[i].y += offset_px;
      all.insert(all.end(), track.begin(), track.end());
    }
    io::WriteTracks(folder / "tracks.txt", all);
    Write("camchain.yaml", kPlainCalibration);
    return "evaluate --tracks " + Quote(folder / "tracks.txt") + " --ground-truth " + Quote(folder / "wall_gt.hdf5") +
           " --calibration " + Quote(folder / "camchain.yaml");
  }

  std::string TrueTrackArguments(const std::string& tracks, const std::string& truth) const {
    return "evaluate --tracks " + Quote(Write("t.txt", tracks)) + " --true-tracks " + Quote(Write("gt.txt", truth));
  }
};

TEST_F(TrackEvaluationTest, StreetTracksMeetTheirBounds) {
  const auto quality = JudgeTracks("street", "street_gt.hdf5", "camchain-imucam-street.yaml");
  ExpectQuality(quality, {.judged = 110.0, .track_error_px = 0.85, .outlier_share = 0.02, .age_share = 0.55});
  // The tables of lifetimes agree where every frame has tracks.
  const std::string lifetimes = ReadFile(folder / "quality" / "lifetime.csv");
  const std::string of_track = ReadFile(folder / "tracks" / "lifetime.csv");
  EXPECT_EQ(lifetimes.substr(lifetimes.find("\ntracks,")), of_track.substr(of_track.find("\ntracks,")));
  EXPECT_NE(ReadFile(folder / "quality" / "tables" / "lifetime.tex").find("Average lifetime (frames)"),
            std::string::npos);
}

TEST_F(TrackEvaluationTest, NightTracksMeetTheirBounds) {
  // The outliers are on the rim of the head lamps' light, which moves with the car.
  ExpectQuality(JudgeTracks("night", "night_gt.hdf5", "camchain-imucam-night.yaml"),
                {.judged = 80.0, .track_error_px = 0.95, .outlier_share = 0.07, .age_share = 0.55});
}

TEST_F(TrackEvaluationTest, HandheldTracksMeetTheirBounds) {
  ExpectQuality(JudgeTracks("handheld", "depth_gt.hdf5", "calib.txt"),
                {.judged = 60.0, .track_error_px = 0.45, .outlier_share = 0.02, .age_share = 0.8});
}

TEST_F(TrackEvaluationTest, DepthMapsGiveErrorAndTrueAge) {
  ASSERT_EQ(Run(SceneArguments(2.0) + To("result")), 0) << err;
  auto quality = Quality("result");
  EXPECT_EQ(quality["truth "], "depth");
  EXPECT_EQ(quality["tracks_judged "], "12");
  EXPECT_NEAR(std::stod(quality["error_median "]), 2.0, 1e-3);
  EXPECT_NEAR(std::stod(quality["error_rmse 3"]), 2.0, 1e-3);
  EXPECT_EQ(std::stod(quality["outlier_share 1"]), 1.0);
  EXPECT_NEAR(std::stod(quality["expected_feature_age_normalized 3"]), 0.5, 0.04);  // lives 1 s of 2 s
  // Asynchronous tracks live as many frames as the odometry makes of them, 25 ms apart.
  EXPECT_NE(ReadFile(folder / "result" / "lifetime.csv").find("\nmean,frames,,,36.750000000\n"), std::string::npos);
  EXPECT_NE(out.find("12 of 12 evaluated, truth: depth\n"), std::string::npos) << out;
  EXPECT_NE(ReadFile(folder / "result" / "track_errors.csv").find("\n11,1500000000.143000000,judged,"),
            std::string::npos);
}

TEST_F(TrackEvaluationTest, TruthIsChosenByContentOrOption) {
  ASSERT_EQ(Run(SceneArguments(0.0) + " --track-truth triangulated" + To("asked")), 0) << err;
  EXPECT_EQ(Quality("asked")["truth "], "triangulated");
  ASSERT_EQ(Run(SceneArguments(0.0, false) + To("found")), 0) << err;
  EXPECT_EQ(Quality("found")["truth "], "triangulated");
  EXPECT_EQ(Refusal(SceneArguments(0.0, false) + " --track-truth depth" + To("none")), 4);
  EXPECT_NE(err.find("depth_image_raw"), std::string::npos) << err;
}

TEST_F(TrackEvaluationTest, TrueTracksServeAnyTracker) {
  const std::string haste = "0.1,13,20,0,1\n0.0,10,20,0,1\n0.2,10,23,0,1\n0.1,9,9,0,2\n";
  ASSERT_EQ(Run(TrueTrackArguments(haste, "1 0 10 20\n1 0.4 10 20\n") + " --track-thresholds 2,4" + To("result")), 0)
      << err;
  auto quality = Quality("result");
  EXPECT_EQ(quality["truth "], "tracks");
  EXPECT_EQ(quality["tracks_judged "], "1");
  EXPECT_EQ(quality["tracks_no_truth "], "1");
  EXPECT_EQ(quality["error_mean 4"], "2.000000000");
  EXPECT_EQ(quality["expected_feature_age_normalized 4"], "0.500000000");
  EXPECT_EQ(quality["outlier_share 2"], "1.000000000");
}

TEST_F(TrackEvaluationTest, ClockOffsetShiftsTheTracks) {
  const std::string arguments = TrueTrackArguments("1 5.0 10 0\n1 5.1 11 0\n1 5.2 12 0\n", "1 0 10 0\n1 0.5 15 0\n");
  EXPECT_EQ(Refusal(arguments + To("none")), 5);
  ASSERT_EQ(Run(arguments + " --set evaluation.estimate_clock_offset_s=-5" + To("moved")), 0) << err;
  EXPECT_EQ(Quality("moved")["error_max "], "0.000000000");
  ASSERT_EQ(Run(arguments + " --time-offset=-5" + To("option")), 0) << err;
  EXPECT_EQ(ReadFile(folder / "option" / "track_errors.csv"), ReadFile(folder / "moved" / "track_errors.csv"));
}

TEST_F(TrackEvaluationTest, OnlyTheIntervalIsEvaluated) {
  const std::string arguments =
      TrueTrackArguments("1 0.0 10 0\n1 0.1 13 0\n1 0.2 13 0\n1 0.3 99 0\n", "1 0 10 0\n1 0.4 10 0\n");
  ASSERT_EQ(Run(arguments + " --from-stamp 0.1 --to-stamp 0.2" + To("part")), 0) << err;
  EXPECT_EQ(Quality("part")["compared_positions "], "2");
  EXPECT_EQ(Quality("part")["error_max "], "3.000000000");
  // Of the 0.1 s asked for, though the point is seen for longer.
  EXPECT_EQ(Quality("part")["expected_feature_age_normalized 5"], "1.000000000");
  EXPECT_EQ(Refusal(arguments + " --from-stamp 7" + To("none")), 5);
}

TEST_F(TrackEvaluationTest, TrajectoryAndTracksTogetherLeaveOneManifest) {
  const std::string arguments = SceneArguments(0.0);
  io::WriteTum(folder / "estimate.txt", evaluation::testing::TrackScene().Poses());
  ASSERT_EQ(Run(arguments + " --align none --estimate " + Quote(folder / "estimate.txt") + To("both")), 0) << err;
  for (const char* name : {"summary.csv", "errors.csv", "track_quality.csv", "track_errors.csv", "lifetime.csv"}) {
    EXPECT_TRUE(fs::exists(folder / "both" / name)) << name;
  }
  const std::string manifest = ReadFile(folder / "both" / "manifest.json");
  for (const char* key : {"\"estimate\"", "\"ground_truth\"", "\"tracks\"", "\"calibration\"", "\"judged_tracks\""}) {
    EXPECT_NE(manifest.find(key), std::string::npos) << key;
  }
  EXPECT_NE(out.find("coverage"), std::string::npos);
  EXPECT_NE(out.find("evaluated"), std::string::npos);
  EXPECT_EQ(Refusal(arguments + To("both")), 8);  // results are not overwritten
}

TEST_F(TrackEvaluationTest, FailedEvaluationLeavesNothing) {
  const std::string arguments = SceneArguments(0.0);
  io::WriteTum(folder / "estimate.txt", evaluation::testing::TrackScene().Poses());
  Write("tracks.txt", "1 0 5 5\n1 0.1 5 nan\n");
  EXPECT_EQ(Refusal(arguments + " --align none --estimate " + Quote(folder / "estimate.txt") + To("both")), 4);
  EXPECT_FALSE(fs::exists(folder / "both"));
}

TEST_F(TrackEvaluationTest, LifetimesOfFewTracksCountTheirOwnFrames) {
  std::string frames;
  std::string single;
  for (int k = 0; k < 20; ++k) {
    const std::string position = ' ' + std::to_string(0.3117 * k) + " 5 5\n";
    single += '1' + position;
    frames += '1' + position + '2' + position;
  }
  ASSERT_EQ(Run(TrueTrackArguments(frames, frames) + To("frames")), 0) << err;
  EXPECT_NE(out.find("lifetime   20.0 +- 0.0 frames, 5.92 +- 0.00 s (2 tracks)\n"), std::string::npos) << out;
  ASSERT_EQ(Run(TrueTrackArguments(single, single) + " --set odometry.max_gap_s=1" + To("single")), 0) << err;
  EXPECT_NE(out.find("(1 tracks, in frames made every 0.025 s)\n"), std::string::npos) << out;
}

TEST_F(TrackEvaluationTest, SameBytesEachTime) {
  const std::string arguments = SceneArguments(0.7);
  ASSERT_EQ(Run(arguments + To("a")), 0) << err;
  ASSERT_EQ(Run(arguments + " --threads 1" + To("b")), 0) << err;
  for (const char* name : {"track_quality.csv", "track_errors.csv", "lifetime.csv"}) {
    EXPECT_EQ(ReadFile(folder / "a" / name), ReadFile(folder / "b" / name)) << name;
  }
}

TEST_F(TrackEvaluationTest, IncompleteCommandLinesAreRefused) {
  const std::string tracks = " --tracks " + Quote(Write("t.txt", "1 0 5 5\n1 0.1 5 5\n"));
  const std::string truth = " --ground-truth " + Quote(Sample("street_gt.hdf5"));
  const std::string calibration = " --calibration " + Quote(Sample("camchain-imucam-street.yaml"));
  for (const std::string& words :
       {truth, tracks, tracks + truth, tracks + calibration, truth + calibration,
        " --true-tracks " + Quote(folder / "t.txt"), tracks + truth + calibration + " --true-tracks t.txt",
        tracks + truth + calibration + " --track-truth guess", " --estimate " + Quote(folder / "t.txt"),
        tracks + truth + calibration + " --track-thresholds 0",
        tracks + truth + calibration + " --track-thresholds nan",
        tracks + truth + calibration + " --track-thresholds a,b"}) {
    EXPECT_EQ(Refusal("evaluate" + words + To("none")), 2) << words << '\n' << err;
    EXPECT_FALSE(fs::exists(folder / "none")) << words;
  }
}

TEST_F(TrackEvaluationTest, TracksOfAnotherSequenceAreRefused) {
  EXPECT_EQ(Refusal(TrueTrackArguments("1 0 5 5\n1 1 5 5\n", "2 0 5 5\n2 1 5 5\n") + To("none")), 5);
  EXPECT_NE(err.find("t.txt"), std::string::npos) << err;
  EXPECT_EQ(Refusal(TrueTrackArguments("1 0 5 5\n1 1 5 5\n", "1 7 5 5\n1 8 5 5\n") + To("none")), 5);
  EXPECT_EQ(Refusal(TrueTrackArguments("1 0 5 5\n1 1 5 nan\n", "1 7 5 5\n1 8 5 5\n") + To("none")), 4);
  EXPECT_EQ(Refusal(TrueTrackArguments("1 0 5 5\n1 1 5 5\n", "") + To("none")), 4);
  const std::string arguments = SceneArguments(0.0);
  Write("camchain.yaml",
        "cam0:\n  camera_model: pinhole\n  intrinsics: [100, 100, 50, 50]\n"
        "  distortion_model: radtan\n  distortion_coeffs: [0, 0, 0, 0]\n  resolution: [101, 101]\n");
  EXPECT_EQ(Refusal(arguments + To("none")), 4);
  EXPECT_NE(err.find("101 x 101"), std::string::npos) << err;
  EXPECT_FALSE(fs::exists(folder / "none"));
}

}  // namespace
}  // namespace evo::app
