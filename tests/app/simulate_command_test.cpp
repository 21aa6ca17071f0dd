// evo-run simulate: what it writes, that it is true, and what is left when it fails.
#include <fcntl.h>

#include <cmath>
#include <map>
#include <vector>

#include "app/evo_run.hpp"
#include "evo/core/parameters.hpp"
#include "evo/events/depth_map.hpp"
#include "evo/io/calibration_io.hpp"
#include "evo/io/checksum.hpp"
#include "evo/io/track_io.hpp"
#include "evo/io/trajectory_io.hpp"
#include "evo/simulation/simulated_run.hpp"
#include "io/hdf5/hdf5.hpp"
#include "simulation/render_scene.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

constexpr char kSmallCamera[] =
    "cam0:\n  camera_model: pinhole\n  intrinsics: [90, 90, 60, 45]\n  distortion_model: radtan\n"
    "  distortion_coeffs: [-0.2, 0.05, 0.001, -0.001]\n  resolution: [120, 90]\n";

/// The largest file that the shell allows stands for the full disk.
constexpr char kFullDisk[] = "trap '' XFSZ; ulimit -f 16;";

class SimulateCommandTest : public EvoRunTest {
 protected:
  static fs::path SceneFile(const std::string& name) { return fs::path(EVO_SOURCE_DIR) / "configs" / "scenes" / name; }

  /// Shell words for a bundled scene, seen by a small camera.
  std::string Small(const std::string& scene, const std::string& result) const {
    return "simulate " + Quote(SceneFile(scene + ".yaml")) +
           " --set scene.calibration=" + Quote(Write("camera.yaml", kSmallCamera)) + " --out " +
           Quote(folder / result) + " ";
  }

  /// What Small simulates.
  simulation::SimulatedRun RunOf(const std::string& scene, const std::string& setting = "") const {
    simulation::SceneOptions options;
    Parameters parameters;
    Register(parameters, options);
    parameters.LoadFile(SceneFile(scene + ".yaml"));
    if (!setting.empty()) parameters.Set(setting);
    options.calibration = Path("camera.yaml");
    return simulation::MakeRun(options);
  }

  /// Must be refused with this exit code and a line that holds `part`, and leave no file in result.
  void ExpectRefusal(const std::string& words, int code, const std::string& part, const std::string& before = "") {
    EXPECT_EQ(Refusal(words + " --out " + Quote(folder / "result"), before), code) << words << '\n' << err;
    EXPECT_NE(err.find(part), std::string::npos) << part << " in: " << err;
    EXPECT_EQ(CountFiles(folder / "result"), 0) << words;
  }

  /// Names, relative to `result`, and contents' checksums of all files but the manifest, which holds times.
  std::map<std::string, std::string> Checksums(const std::string& result) const {
    std::map<std::string, std::string> sums;
    for (const auto& entry : fs::recursive_directory_iterator(folder / result)) {
      const std::string name = fs::relative(entry.path(), folder / result).string();
      if (entry.is_regular_file() && name != "manifest.json") sums[name] = io::Sha256(entry.path());
    }
    return sums;
  }

  void ExpectSameBytesForAnyThreads(const std::string& words) {
    ASSERT_EQ(Run(words + "--threads 1 --force"), 0) << err;
    const auto one = Checksums("result");
    for (const char* threads : {"2", "3"}) {
      ASSERT_EQ(Run(words + "--force --threads " + threads), 0) << err;
      EXPECT_EQ(Checksums("result"), one) << threads;
    }
    EXPECT_GE(one.size(), 3u);
  }
};

TEST_F(SimulateCommandTest, MvsecSequencesHoldWhatThePublishedOnesDo) {
  ASSERT_EQ(Run(Small("slider", "a") + "--duration 0.12 --set output.flow=true -q"), 0) << err;
  EXPECT_EQ(err, "");
  EXPECT_NE(out.find("sequence   slider: 0.1 s"), std::string::npos) << out;
  EXPECT_NE(out.find(" negative for each positive one"), std::string::npos) << out;
  EXPECT_NE(out.find("results    " + Path("a") + "\n"), std::string::npos) << out;
  EXPECT_EQ(CountFiles(folder / "a"), 4);
  const io::hdf5::File data(folder / "a" / "slider_data.hdf5");
  const io::hdf5::File truth(folder / "a" / "slider_gt.hdf5");
  const auto shape = [](const io::hdf5::File& file, const std::string& name) {
    return file.Open("davis/left/" + name).shape();
  };
  using Shape = std::vector<hsize_t>;
  EXPECT_EQ(shape(data, "image_raw"), (Shape{3, 90, 120}));
  EXPECT_EQ(shape(data, "image_raw_ts"), (Shape{3}));
  EXPECT_EQ(shape(data, "image_raw_event_inds"), (Shape{3}));
  EXPECT_EQ(shape(data, "events").at(1), 4u);
  for (const char* poses : {"odometry", "pose"}) EXPECT_EQ(shape(truth, poses), (Shape{25, 4, 4}));
  for (const char* maps : {"depth_image_raw", "depth_image_rect"}) EXPECT_EQ(shape(truth, maps), (Shape{3, 90, 120}));
  EXPECT_EQ(shape(truth, "flow_dist"), (Shape{2, 2, 90, 120}));
  EXPECT_EQ(shape(truth, "flow_dist_ts"), (Shape{2}));
  EXPECT_EQ(io::ReadCalibration(folder / "a" / "camchain-imucam-slider.yaml").width, 120);
}

/// Depth and flow of the rectified image against single rays and the projection of the points that they meet.
TEST_F(SimulateCommandTest, RectifiedMapsAreThoseOfAnIdealLens) {
  const std::string handheld = "--set motion.handheld.frequency_hz=3 ";
  ASSERT_EQ(Run(Small("handheld_boxes", "a") + "--duration 0.12 --set output.flow=true -q " + handheld), 0) << err;
  const simulation::SimulatedRun run = RunOf("handheld_boxes", "motion.handheld.frequency_hz=3");
  const geometry::Camera ideal(geometry::Rectified(run.camera.calibration()));
  const io::hdf5::File truth(folder / "a" / "handheld_boxes_gt.hdf5");
  std::vector<double> depth(90 * 120);
  std::vector<double> flow(2 * 90 * 120);
  truth.Open("davis/left/depth_image_rect").Read(1, 1, depth.data());
  truth.Open("davis/left/flow_dist").Read(1, 1, flow.data());
  const geometry::SE3 T_world_now = run.T_world_cam(50'000'000);
  const geometry::SE3 T_next_now = run.T_world_cam(100'000'000).Inverse() * T_world_now;
  double longest = 0.0;
  for (int i = 0; i < 90 * 120; i += 37) {
    const Eigen::Vector2d pixel(i % 120, i / 120);
    const Eigen::Vector2d ray((pixel.x() - 60.0) / 90.0, (pixel.y() - 45.0) / 90.0);
    const simulation::Hit hit = CastRay(*run.scene, ray, 50'000'000, T_world_now);
    if (hit.margin < 1e-4) continue;
    const Eigen::Vector2d moved = ideal.Project(T_next_now * (hit.depth * ray.homogeneous())) - pixel;
    const auto place = static_cast<std::size_t>(i);
    EXPECT_NEAR(depth[place], hit.depth, 1e-4 * hit.depth) << pixel.transpose();
    EXPECT_NEAR(flow[place], moved.x(), 1e-3) << pixel.transpose();
    EXPECT_NEAR(flow[90 * 120 + place], moved.y(), 1e-3) << pixel.transpose();
    longest = std::max(longest, moved.norm());
  }
  EXPECT_GT(longest, 1.0);
}

TEST_F(SimulateCommandTest, UzhSequencesHoldWhatThePublishedOnesDo) {
  ASSERT_EQ(Run(Small("slider", "u") + "--format uzh --duration 0.12 --preview-every 0.1"), 0) << err;
  for (const char* name : {"events.txt", "groundtruth.txt", "calib.txt", "images.txt", "images/frame_00000002.png",
                           "depth_gt.hdf5", "preview/frame_0000.100s.png", "manifest.json"}) {
    EXPECT_TRUE(fs::exists(folder / "u" / name)) << name;
  }
  EXPECT_EQ(CountFiles(folder / "u"), 11);
  EXPECT_EQ(Run("info " + Quote(folder / "u")), 0) << err;
  EXPECT_EQ(Run("info " + Quote(folder / "u" / "depth_gt.hdf5")), 0) << err;
  EXPECT_NE(out.find("3 of 120 x 90 px"), std::string::npos) << out;
}

TEST_F(SimulateCommandTest, SameBytesForAnyNumberOfThreads) {
  ExpectSameBytesForAnyThreads(Small("driving_night", "result") +
                               "--set motion.vehicle.duration_s=4 --set motion.vehicle.start_at_rest_s=0 "
                               "--set output.flow=true --duration 0.06 ");
}

TEST_F(SimulateCommandTest, SameTextForAnyNumberOfThreads) {
  ExpectSameBytesForAnyThreads(Small("handheld_boxes", "result") + "--format uzh --duration 0.11 ");
}

/// Where points of the scene truly are, found by one ray at a time in double precision: tracks that begin on places
/// that lie on one surface with what is around them, and end where another surface hides them.
events::Tracks FollowPoints(const simulation::SimulatedRun& run, int count, TimeNs end) {
  constexpr TimeNs kStep = 20'500'000;
  Random random(3);
  const auto surface_at = [&](const Eigen::Vector2d& pixel, TimeNs t, double* depth) {
    const auto ray = run.camera.Contains(pixel) ? run.camera.Undistort(pixel) : std::nullopt;
    const simulation::Hit hit = ray ? CastRay(*run.scene, *ray, t, run.T_world_cam(t)) : simulation::Hit();
    if (depth) *depth = hit.depth;
    return hit.surface;
  };
  events::Tracks tracks;
  for (int id = 0; id < count; ++id) {
    const TimeNs start = random.Index(10) * kStep;
    const Eigen::Vector2d first(random.Uniform(5.0, run.camera.width() - 6.0),
                                random.Uniform(5.0, run.camera.height() - 6.0));
    double depth = 0.0;
    const int surface = surface_at(first, start, &depth);
    bool inside = surface >= 0;
    for (const Eigen::Vector2d& side : {Eigen::Vector2d(2, 2), {2, -2}, {-2, 2}, {-2, -2}}) {
      inside = inside && surface_at(first + side, start, nullptr) == surface;
    }
    if (!inside) continue;
    const Eigen::Vector3d point = run.T_world_cam(start) * (depth * run.camera.Undistort(first)->homogeneous());
    for (TimeNs t = start; t <= end; t += kStep) {
      const Eigen::Vector2d pixel = run.camera.Project(run.T_world_cam(t).Inverse() * point);
      if (surface_at(pixel, t, nullptr) != surface) break;
      tracks.push_back({id, t, pixel.x(), pixel.y()});
    }
  }
  return tracks;
}

/// The oracle of evaluate --tracks against points whose places are known from the making of the scene.
TEST_F(SimulateCommandTest, PointsOfTheSceneAreTracksWithoutError) {
  ASSERT_EQ(Run(Small("handheld_boxes", "room") + "--duration 1 --set output.start_s=0 --set simulation.samples=1"), 0)
      << err;
  io::WriteTracks(folder / "tracks.txt", FollowPoints(RunOf("handheld_boxes"), 100, FromSeconds(0.99)));
  ASSERT_EQ(Run("evaluate --no-plots --tracks " + Quote(folder / "tracks.txt") + " --ground-truth " +
                Quote(folder / "room" / "handheld_boxes_gt.hdf5") + " --calibration " + Quote(folder / "camera.yaml") +
                " --out " + Quote(folder / "quality")),
            0)
      << err;
  const std::string csv = ReadFile(folder / "quality" / "track_quality.csv");
  const auto value = [&](const std::string& row) {
    const auto place = csv.find("\n" + row);
    return place == std::string::npos ? NAN : std::stod(csv.substr(csv.rfind(',', csv.find('\n', place + 1)) + 1));
  };
  EXPECT_GT(value("tracks_judged,"), 40.0);
  EXPECT_LT(value("error_median,px,1."), 0.001);
  EXPECT_LT(value("error_max,px,1."), 0.05);
  EXPECT_GT(value("expected_feature_age_normalized,share,1."), 0.95);
}

/// What a run that fails must leave: the folder as it was.
class SimulateFailureTest : public SimulateCommandTest {
 protected:
  /// Starts a long run, ends it with `signal` once it writes, and returns how it ended.
  int Interrupt(const std::string& format, int signal) {
    const std::string scene = SceneFile("slider.yaml");
    const std::string result = Path("result");
    const pid_t child = ::fork();
    if (child == 0) {
      const int null = ::open("/dev/null", O_WRONLY);
      ::dup2(null, STDOUT_FILENO);
      ::dup2(null, STDERR_FILENO);
      ::execl(EVO_RUN, EVO_RUN, "simulate", scene.c_str(), "--format", format.c_str(), "--out", result.c_str(), "--set",
              "motion.slider.duration_s=600", "--preview-every", "0.05", static_cast<char*>(nullptr));
      ::_exit(1);
    }
    for (int i = 0; i < 3000 && CountFiles(result) < 4; ++i) ::usleep(10'000);
    EXPECT_GE(CountFiles(result), 4);
    ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
  }
};

TEST_F(SimulateFailureTest, InterruptedItLeavesNothing) {
  for (const char* format : {"mvsec", "uzh"}) {
    for (const int signal : {SIGINT, SIGTERM}) {
      const int status = Interrupt(format, signal);
      EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << format << ' ' << status;
      EXPECT_EQ(CountFiles(folder / "result"), 0) << format;
    }
  }
}

TEST_F(SimulateFailureTest, OnAFullDiskItLeavesNothing) {
  for (const char* format : {"mvsec", "uzh"}) {
    EXPECT_EQ(Refusal(Small("slider", "result") + "-q --duration 0.3 --format " + format, kFullDisk), 8);
    EXPECT_NE(err.find("disk full"), std::string::npos) << err;
    EXPECT_FALSE(fs::exists(folder / "result"));
  }
}

TEST_F(SimulateFailureTest, EarlierResultsStayUntilTheNewOnesAreWhole) {
  const std::string words = Small("slider", "result") + "-q --format uzh --duration 0.06 --preview-every 0.05 ";
  ASSERT_EQ(Run(words + "--set simulation.depth_hz=100"), 0) << err;
  const auto before = Checksums("result");
  EXPECT_EQ(Refusal(words), 8);
  EXPECT_NE(err.find("--force"), std::string::npos) << err;
  EXPECT_EQ(Refusal(words + "--force", kFullDisk), 8);
  EXPECT_EQ(Checksums("result"), before);
  Write("result/notes.txt", "kept");
  Write("result/images/mine.png", "kept");
  ASSERT_EQ(Run(words + "--force --set simulation.depth_hz=0 --set simulation.image_hz=10"), 0) << err;
  const auto after = Checksums("result");
  EXPECT_FALSE(after.contains("depth_gt.hdf5"));
  EXPECT_FALSE(after.contains("images/frame_00000001.png"));
  EXPECT_TRUE(after.contains("notes.txt") && after.contains("images/mine.png"));
}

TEST_F(SimulateFailureTest, AnOutputThatCannotBeIsRefused) {
  Write("file", "in the way");
  EXPECT_EQ(Refusal(Small("slider", "file")), 8);
  EXPECT_EQ(Refusal(Small("slider", "file/result")), 8);
  EXPECT_EQ(Refusal("simulate " + Quote(SceneFile("slider.yaml"))), 2);
  EXPECT_NE(err.find("--out"), std::string::npos) << err;
}

TEST_F(SimulateFailureTest, BadScenesAreRefused) {
  const auto expect = [&](const std::string& text, const std::string& part) {
    ExpectRefusal("simulate " + Quote(Write("scene.yaml", text)), 3, part);
    EXPECT_NE(err.find("scene.yaml"), std::string::npos) << err;
  };
  expect("scene:\n  knd: room\n", "scene.yaml:2: unknown parameter 'scene.knd'; did you mean 'scene.kind'?");
  expect("scene:\n  seed: many\n", "scene.yaml:2: 'scene.seed' is 'many' but must be a whole number");
  expect("scene:\n  kind: sea\n", "street, room, slider");
  expect("sensor:\n  threshold_on: 99\n", "must be a number in");
  expect("sensor:\n  threshold_on: .nan\n", "must be a number in");
  expect("scene:\n  seed: 1\n  seed: 2\n", "scene.yaml:3: 'scene.seed' comes twice");
  expect("a: [1,\n", "not valid YAML");
  expect("- 1\n", "'name: value'");
  expect("", "empty file");
  expect(std::string("\x7F"
                     "ELF\0\0",
                     6),
         "no text");
  expect("scene:\n  kind: room\n", "has no road");
  ExpectRefusal("simulate " + Quote(folder / "absent.yaml"), 3, "absent.yaml: cannot read");
  ExpectRefusal("simulate " + Quote(folder), 3, "is a folder");
}

TEST_F(SimulateFailureTest, BadOptionsAreRefused) {
  const std::string words = "simulate " + Quote(SceneFile("slider.yaml"));
  for (const char* duration : {"0", "-1", "nan", "inf", "1e9", "soon"}) {
    ExpectRefusal(words + " --duration=" + duration, 2, std::string("'") + duration + "' is not a number from 0.001");
  }
  ExpectRefusal(words + " --duration 100", 2, "raise motion.slider.duration_s");
  ExpectRefusal(words + " --format hdf4", 2, "--format");
  ExpectRefusal(words + " --seed=-1", 2, "--seed");
  ExpectRefusal(words + " --preview-every nan", 2, "--preview-every");
  ExpectRefusal(words + " --preview-every 1 --set simulation.image_hz=0", 2, "simulation.image_hz");
  ExpectRefusal(words + " --set output.flow=true --set simulation.depth_hz=0", 3, "simulation.depth_hz");
  ExpectRefusal(words + " --format uzh --set scene.calibration=davis346", 3, "write a camchain instead");
}

TEST_F(SimulateFailureTest, BadCalibrationsAreRefused) {
  const auto expect = [&](const std::string& calibration, int code, const std::string& part) {
    ExpectRefusal("simulate --set scene.calibration=" + Quote(calibration), code, part);
  };
  expect(Path("absent.yaml"), 4, "absent.yaml: no such file");
  expect("", 3, "scene.calibration");
  expect(Write("empty.yaml", ""), 4, "empty file");
  std::string huge = kSmallCamera;
  huge.replace(huge.find("[120, 90]"), 9, "[60000, 60000]");
  expect(Write("huge.yaml", huge), 4, "huge.yaml: a sensor of 60000 x 60000 px is too large");
}

TEST_F(SimulateFailureTest, BadMotionFilesAreRefused) {
  const auto expect = [&](const std::string& poses, int code, const std::string& part, const std::string& more = "") {
    ExpectRefusal("simulate --set scene.kind=room --set motion.kind=file --set motion.file=" +
                      Quote(Write("motion.txt", poses)) + more,
                  code, part);
  };
  const std::string first = "0 0 0 0 0 0 0 1\n";
  const std::string second = "1 0 0 1 0 0 0 1\n";
  expect("", 4, "empty file");
  expect(first, 4, "a single pose is no motion");
  expect(second + first, 4, "motion.txt:2: the stamp");
  expect(first + first, 4, "motion.txt:2: the stamp");
  expect(first + "1 nan 0 0 0 0 0 1\n", 4, "motion.txt:2: 'nan'");
  expect(first + "1 0 0 0 0 0 0 2\n", 4, "motion.txt:2: the quaternion");
  expect(first + second, 2, "give a longer trajectory", " --duration 2");
  ExpectRefusal("simulate --set scene.kind=room --set motion.kind=file", 3, "motion.file names none");
  ExpectRefusal("simulate --set scene.kind=room --set motion.kind=file --set motion.file=" + Quote(folder), 4,
                "folder");
}

}  // namespace
}  // namespace evo::app
