// What evo-run says of inputs that cannot be used: exit code, one line that names the file, nothing half-written.
#include <cmath>
#include <vector>

#include "app/evo_run.hpp"
#include "io/hdf5_support.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

constexpr int kUsage = 2;
constexpr int kConfiguration = 3;
constexpr int kInput = 4;
constexpr int kNothingToDo = 5;
constexpr int kTrackingLost = 6;
constexpr int kDegenerate = 7;
constexpr int kOutput = 8;

class BadInputTest : public EvoRunTest {
 protected:
  /// The command must be refused with this exit code and a line that holds all `parts`, and leave no file in result.
  void ExpectRefusal(const std::string& words, int code, const std::vector<std::string>& parts,
                     const std::string& before = "") {
    EXPECT_EQ(Refusal(words + " -q --out " + Quote(folder / "result"), before), code) << words << '\n' << err;
    for (const auto& part : parts) EXPECT_NE(err.find(part), std::string::npos) << part << " in: " << err;
    EXPECT_EQ(CountFiles(folder / "result"), 0);
  }

  void ExpectEventsRefused(const fs::path& events, const std::vector<std::string>& parts) {
    auto all = parts;
    all.push_back(events.filename());
    ExpectRefusal("run --events " + Quote(events) + " --calibration " + Quote(kCalibration), kInput, all);
  }
  void ExpectCalibrationRefused(const fs::path& calibration, const std::vector<std::string>& parts) {
    ExpectRefusal("run --events " + Quote(kEvents) + " --calibration " + Quote(calibration), kInput, parts);
  }
  void ExpectTruthRefused(const fs::path& truth, int code, const std::vector<std::string>& parts) {
    auto all = parts;
    all.push_back(truth.filename());
    ExpectRefusal("run --events " + Quote(Sample()) + " --ground-truth " + Quote(truth), code, all);
  }
  void ExpectTracksRefused(const fs::path& tracks, int code, const std::vector<std::string>& parts) {
    auto all = parts;
    all.push_back(tracks.filename());
    ExpectRefusal("odometry --tracks " + Quote(tracks) + " --calibration " + Quote(kCalibration), code, all);
  }

  fs::path WriteEmpty(const std::string& name) const { return Write(name, ""); }
  fs::path WriteHead(const std::string& name, const fs::path& source, std::size_t bytes) const {
    return Write(name, ReadFile(source).substr(0, bytes));
  }

  /// An event text of 1000 lines with `line` as number 500.
  fs::path WriteEventText(const std::string& name, const std::string& line) const {
    std::string text;
    for (int i = 1; i <= 1000; ++i) {
      text += i == 500 ? line + "\n" : "1." + std::to_string(100000 + i) + " " + std::to_string(i % 346) + " 7 1\n";
    }
    return Write(name, text);
  }

  /// An MVSEC file of 1000 events with `value` in a column of row 500.
  fs::path WriteEventTable(const std::string& name, std::size_t column, double value) const {
    std::vector<double> rows;
    for (int i = 0; i < 1000; ++i) {
      for (const double cell : {static_cast<double>(i % 346), 7.0, 1504650000.0 + 1e-5 * i, 1.0}) rows.push_back(cell);
    }
    rows[4 * 500 + column] = value;
    io::StoreEvents(folder / name, rows);
    return folder / name;
  }

  /// `count` tracks over 60 frames that move `step_px` right from each frame to the next.
  fs::path WriteTrackText(const std::string& name, int count, double step_px) const {
    std::string text = "# id timestamp x y\n";
    for (int frame = 0; frame < 60; ++frame) {
      for (int id = 0; id < count; ++id) {
        text += std::to_string(id) + " " + std::to_string(0.02 * frame) + " " +
                std::to_string(10.0 + id * 37 % 200 + step_px * frame) + " " + std::to_string(10 + id * 23 % 230) +
                "\n";
      }
    }
    return Write(name, text);
  }

  const fs::path kEvents = Sample("street_data.hdf5");
  const fs::path kCalibration = Sample("camchain-imucam-street.yaml");
  const fs::path kTruth = Sample("street_gt.hdf5");
  const fs::path kTrajectory = fs::path(EVO_SOURCE_DIR) / "tests" / "evaluation" / "data" / "gt.txt";
};

TEST_F(BadInputTest, MissingFiles) {
  ExpectEventsRefused(folder / "absent.hdf5", {"no such file"});
  ExpectEventsRefused(folder / "absent", {"no such file"});
  ExpectCalibrationRefused(folder / "absent.yaml", {"absent.yaml", "no such file"});
  ExpectTruthRefused(folder / "absent_gt.hdf5", kInput, {"no such file"});
  ExpectTracksRefused(folder / "absent.txt", kInput, {"no such file"});
}

TEST_F(BadInputTest, FolderWithoutRecording) {
  fs::create_directories(folder / "nothing");
  ExpectEventsRefused(folder / "nothing", {"no *_data.hdf5"});
}

TEST_F(BadInputTest, EmptyFiles) {
  ExpectEventsRefused(WriteEmpty("empty.hdf5"), {"empty file"});
  ExpectEventsRefused(WriteEmpty("empty.txt"), {"empty file"});
  ExpectCalibrationRefused(WriteEmpty("empty.yaml"), {"empty.yaml", "empty file"});
  ExpectTruthRefused(WriteEmpty("empty_gt.hdf5"), kInput, {"empty file"});
  ExpectTracksRefused(WriteEmpty("empty.txt"), kInput, {"empty file"});
}

TEST_F(BadInputTest, TruncatedHdf5) {
  ExpectEventsRefused(WriteHead("cut.hdf5", kEvents, 1'500'000), {"cut short"});
  ExpectTruthRefused(WriteHead("cut_gt.hdf5", kTruth, 5'000), kInput, {"cut short"});
}

TEST_F(BadInputTest, TruncatedEventText) {
  const std::string text = ReadFile(WriteEventText("whole.txt", "1.100500 3 7 1"));
  ExpectEventsRefused(Write("cut.txt", text.substr(0, text.size() - 5)), {"cut.txt:1000", "'t x y p'"});
}

TEST_F(BadInputTest, TruncatedTrackText) {
  const std::string text = ReadFile(WriteTrackText("whole.txt", 60, 1.0));
  ExpectTracksRefused(Write("cut.txt", text.substr(0, text.rfind(' '))), kInput, {"cut.txt:3601", "'id t x y'"});
}

TEST_F(BadInputTest, TruncatedTrajectoryText) {
  const std::string text = ReadFile(kTrajectory);
  ExpectTruthRefused(Write("cut.txt", text.substr(0, text.rfind(' '))), kInput, {"cut.txt:"});
}

TEST_F(BadInputTest, DamagedHdf5Block) {
  std::string bytes = ReadFile(kEvents);
  std::fill(bytes.begin() + 1'000'000, bytes.begin() + 2'000'000, '\x55');
  ExpectEventsRefused(Write("damaged.hdf5", bytes), {"damaged"});
}

TEST_F(BadInputTest, EventsOfTheWrongKind) {
  ExpectEventsRefused(kCalibration, {"Kalibr calibration", "expected an MVSEC .hdf5"});
  ExpectEventsRefused(Write("image.png", "\x89PNG\r\n\x1a\n...."), {"PNG image"});
  ExpectEventsRefused(kTrajectory, {"trajectory text"});
  ExpectEventsRefused(kTruth, {"no data set davis/left/events"});
  ExpectEventsRefused(Write("text.hdf5", "not HDF5 at all\n"), {"text.hdf5:1"});
}

TEST_F(BadInputTest, CalibrationOfTheWrongKind) {
  ExpectCalibrationRefused(kEvents, {"street_data.hdf5", "HDF5 file", "expected a Kalibr camchain"});
  ExpectCalibrationRefused(kTrajectory, {"gt.txt", "trajectory text"});
}

TEST_F(BadInputTest, TracksOfTheWrongKind) {
  ExpectTracksRefused(kCalibration, kInput, {"Kalibr calibration", "expected a track file"});
  ExpectTracksRefused(kEvents, kInput, {"HDF5 file"});
  ExpectTracksRefused(WriteEventText("events.txt", "1.100500 3 7 1"), kInput, {"events.txt:1"});
}

TEST_F(BadInputTest, TruthOfTheWrongKind) {
  ExpectTruthRefused(WriteTrackText("tracks.txt", 10, 1.0), kInput, {"track file", "expected an MVSEC _gt.hdf5"});
  ExpectTruthRefused(WriteEventText("text.hdf5", "1.100500 3 7 1"), kInput, {"event text"});
  ExpectTruthRefused(kEvents, kInput, {"no data set davis/left/odometry"});
}

TEST_F(BadInputTest, NoTrajectoryToEvaluate) {
  ExpectRefusal("evaluate --estimate " + Quote(kEvents) + " --ground-truth " + Quote(kTruth), kInput,
                {"street_data.hdf5", "HDF5 file"});
}

TEST_F(BadInputTest, NotANumberInText) {
  ExpectEventsRefused(WriteEventText("nan.txt", "nan 3 7 1"), {"nan.txt:500", "stamp"});
  ExpectEventsRefused(WriteEventText("nan_pixel.txt", "1.1005 nan 7 1"), {"nan_pixel.txt:500", "pixel"});
  ExpectTracksRefused(Write("nan_tracks.txt", "0 1.5 3.5 4.5\n0 nan 3.5 4.5\n"), kInput, {"nan_tracks.txt:2"});
}

TEST_F(BadInputTest, NotANumberInHdf5) {
  ExpectEventsRefused(WriteEventTable("stamp.hdf5", 2, NAN), {"davis/left/events row 500", "stamp"});
  ExpectEventsRefused(WriteEventTable("pixel.hdf5", 0, NAN), {"davis/left/events row 500", "pixel"});
}

TEST_F(BadInputTest, TimeRunsBackwards) {
  ExpectEventsRefused(WriteEventText("back.txt", "1.000001 3 7 1"), {"back.txt:500", "backwards"});
  ExpectEventsRefused(WriteEventTable("back.hdf5", 2, 1504649999.0), {"row 500", "backwards"});
}

TEST_F(BadInputTest, PixelOutsideTheSensor) {
  ExpectEventsRefused(WriteEventText("off.txt", "1.100500 346 7 1"), {"off.txt:500", "(346, 7)", "346 x 260"});
  ExpectEventsRefused(WriteEventTable("off.hdf5", 1, 260.0), {"row 500", "260)", "346 x 260"});
  ExpectEventsRefused(WriteEventTable("minus.hdf5", 0, -1.0), {"row 500", "(-1, 7)"});
}

TEST_F(BadInputTest, CalibrationOfAnotherSensor) {
  const fs::path calibration = Write("calib.txt", "199.1 198.8 132.2 110.7 -0.368 0.150 -0.0003 -0.0006 0.0\n");
  ExpectCalibrationRefused(calibration, {"street_data.hdf5", "240 x 180", "give the calibration of this recording"});
  ExpectRefusal("run --events " + Quote(Sample()) + " --sensor 240x180", kInput,
                {"camchain-imucam-street.yaml", "346 x 260", "240 x 180"});
}

TEST_F(BadInputTest, UnknownDistortionModel) {
  std::string text = ReadFile(kCalibration);
  text.replace(text.find("equidistant"), 11, "omnivision");
  ExpectCalibrationRefused(Write("camchain.yaml", text), {"camchain.yaml:4", "omnivision", "equidistant and radtan"});
}

TEST_F(BadInputTest, TracksOfAnotherSensor) {
  ExpectTracksRefused(WriteTrackText("tracks.txt", 60, 40.0), kInput, {"346 x 260", "do not belong together"});
}

TEST_F(BadInputTest, IntervalAfterTheEnd) {
  ExpectRefusal("run --events " + Quote(Sample()) + " --from 60", kNothingToDo, {"street_data.hdf5", "1.4999"});
  ExpectRefusal("run --events " + Quote(Sample()) + " --to 0.001", kNothingToDo, {"street_data.hdf5"});
}

TEST_F(BadInputTest, IntervalThatEndsBeforeItBegins) {
  ExpectRefusal("run --events " + Quote(Sample()) + " --from 1 --to 0.5", kUsage, {"--to", "--from"});
  ExpectRefusal("run --events " + Quote(Sample()) + " --from=-1", kUsage, {"--from"});
  ExpectRefusal("run --events " + Quote(Sample()) + " --from soon", kUsage, {"--from", "soon"});
}

TEST_F(BadInputTest, UnknownParameter) {
  const std::string run = "run --events " + Quote(Sample());
  ExpectRefusal(run + " --set tracker.featurs=100", kConfiguration, {"tracker.featurs", "'tracker.features'"});
  Write("bad.yaml", "tracker:\n  features: 100\n  bordr_px: 4\n");
  ExpectRefusal(run + " --config " + Quote(folder / "bad.yaml"), kConfiguration, {"bad.yaml:3", "'tracker.border_px'"});
  ExpectRefusal(run + " --config " + Quote(folder / "absent.yaml"), kConfiguration, {"absent.yaml"});
}

TEST_F(BadInputTest, UnknownOption) {
  ExpectRefusal("run --speed 9 --events " + Quote(Sample()), kUsage, {"--speed"});
  ExpectRefusal("track --ground-truth x --events " + Quote(Sample()), kUsage, {"--ground-truth"});
}

TEST_F(BadInputTest, NoCalibration) {
  ExpectRefusal("run --events " + Quote(kEvents), kUsage, {"street_data.hdf5", "--calibration"});
}

TEST_F(BadInputTest, TruthOfAnotherTime) {
  ExpectTruthRefused(kTrajectory, kNothingToDo, {"do not overlap", "1506117900.0"});
}

TEST_F(BadInputTest, TracksWithoutParallax) {
  ExpectTracksRefused(WriteTrackText("still.txt", 60, 0.0), kTrackingLost, {"too little motion"});
}

TEST_F(BadInputTest, TooFewTracks) {
  ExpectTracksRefused(WriteTrackText("few.txt", 3, 1.0), kTrackingLost, {"only 3 tracks"});
}

TEST_F(BadInputTest, DegenerateAlignment) {
  const fs::path line = kTrajectory.parent_path() / "line.txt";
  ExpectRefusal("evaluate --align se3 --estimate " + Quote(line) + " --ground-truth " + Quote(line), kDegenerate,
                {"line.txt"});
}

TEST_F(BadInputTest, FileInPlaceOfTheOutputFolder) {
  Write("file", "in the way");
  for (const char* place : {"file", "file/result"}) {
    EXPECT_EQ(Refusal("run -q --events " + Quote(Sample()) + " --out " + Quote(folder / place)), kOutput);
    EXPECT_NE(err.find("file: is not a folder"), std::string::npos) << err;
  }
  EXPECT_EQ(ReadFile(folder / "file"), "in the way");
}

TEST_F(BadInputTest, EarlierResultsStayUnlessForced) {
  fs::create_directories(folder / "result");
  const std::string kept = "result/tracks.txt";
  Write(kept, "precious");
  EXPECT_EQ(Refusal("run -q --events " + Quote(Sample()) + " --out " + Quote(folder / "result")), kOutput);
  EXPECT_NE(err.find("--force"), std::string::npos) << err;
  EXPECT_EQ(ReadFile(folder / kept), "precious");
  EXPECT_EQ(CountFiles(folder / "result"), 1);
}

/// The largest file that the shell allows stands for the full disk: no privilege is needed, and the call that fails is
/// the same.
TEST_F(BadInputTest, FullDisk) {
  const std::string limit = "trap '' XFSZ; ulimit -f 16;";
  ExpectRefusal("run --no-plots --to 0.3 --events " + Quote(Sample()), kOutput, {"tracks.txt", "disk full"}, limit);
  ExpectRefusal("run --draw-every 1 --to 0.3 --events " + Quote(Sample()), kOutput, {"images", "disk full"}, limit);
}

}  // namespace
}  // namespace evo::app
