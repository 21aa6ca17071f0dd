#include "evo/simulation/simulated_run.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "evo/core/error.hpp"
#include "evo/core/parameters.hpp"
#include "evo/geometry/known_cameras.hpp"
#include "evo/io/calibration_io.hpp"
#include "simulation/world/scene.hpp"

namespace evo::simulation {
namespace {

namespace fs = std::filesystem;

std::set<std::string> SceneFiles() {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(EVO_SOURCE_DIR) / "configs" / "scenes")) {
    // What is drawn at random has tests of its own.
    if (entry.path().filename() != "random.yaml") names.insert(entry.path().filename());
  }
  return names;
}

void Load(const std::string& name, SceneOptions* options) {
  Parameters parameters;
  Register(parameters, *options);
  parameters.LoadFile(fs::path(EVO_SOURCE_DIR) / "configs" / "scenes" / name);
}

/// The message of the Error of this kind that MakeRun must throw.
std::string Refusal(const SceneOptions& options, ErrorKind kind) {
  try {
    MakeRun(options);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

TEST(SimulatedRun, DrivingDayIsThePapersRun) {
  SceneOptions options;
  Load("driving_day.yaml", &options);
  const SimulatedRun run = MakeRun(options);
  EXPECT_EQ(run.duration, FromSeconds(60.0));
  const geometry::Trajectory poses = SamplePoses(run.T_world_cam, run.duration, 20.0);
  ASSERT_EQ(poses.size(), 1201u);
  double length = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].t - poses[i - 1].t, 50'000'000);
    length += (poses[i].T_world_cam.translation() - poses[i - 1].T_world_cam.translation()).norm();
  }
  EXPECT_NEAR(length, 440.0, 10.0);
}

/// What the scene's head comment gives as its short form; the whole scene where it gives none.
SimulatedRun ShortForm(const std::string& name) {
  SceneOptions options;
  Load(name, &options);
  const SimulatedRun run = MakeRun(options);
  std::ifstream file(fs::path(EVO_SOURCE_DIR) / "configs" / "scenes" / name);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  std::smatch match;
  if (!std::regex_search(text, match, std::regex("Short form: --from (\\d+) --duration (\\d+)"))) return run;
  return PartOf(run, FromSeconds(std::stod(match[1])), FromSeconds(std::stod(match[2])));
}

double Speed(const SimulatedRun& run, double t) {
  return (run.T_world_cam(FromSeconds(t + 0.01)).translation() - run.T_world_cam(FromSeconds(t)).translation()).norm() /
         0.01;
}

TEST(SimulatedRun, EveryBundledSceneHasAShortFormThatShowsItsSubject) {
  const std::set<std::string> expected{"bumps.yaml",       "driving_day.yaml",    "driving_night.yaml",
                                       "highway.yaml",     "handheld_boxes.yaml", "slider.yaml",
                                       "stop_and_go.yaml", "traffic.yaml",        "turns.yaml"};
  EXPECT_EQ(SceneFiles(), expected);
  for (const auto& name : SceneFiles()) {
    const SimulatedRun run = ShortForm(name);
    EXPECT_GT(run.scene->surfaces.size(), 3u) << name;
    EXPECT_GE(run.duration, FromSeconds(2.0)) << name;
    EXPECT_LE(run.duration, FromSeconds(10.0)) << name;
    const double seconds = ToSeconds(run.duration);
    double highest = 0.0, slowest = 1e9, fastest = 0.0;
    for (double t = 0.0; t < seconds; t += 0.02) {
      const geometry::SE3 pose = run.T_world_cam(FromSeconds(t));
      const geometry::SE3 next = run.T_world_cam(FromSeconds(t + 0.02));
      highest = std::max(highest, geometry::so3::Log(pose.rotation().conjugate() * next.rotation()).norm() / 0.02);
      slowest = std::min(slowest, Speed(run, t));
      fastest = std::max(fastest, Speed(run, t));
    }
    const geometry::SE3 start = run.T_world_cam(0), end = run.T_world_cam(run.duration);
    const double turned = geometry::so3::Log(start.rotation().conjugate() * end.rotation()).norm();
    if (name == "bumps.yaml" || name.starts_with("driving")) {
      EXPECT_GT(highest, 0.2) << name << ": no bump";
    }
    if (name == "stop_and_go.yaml") {
      EXPECT_LT(slowest, 0.01);
      EXPECT_GT(Speed(run, 0.0), 2.0);
      EXPECT_GT(Speed(run, seconds), 2.0);
    }
    if (name == "turns.yaml") {
      EXPECT_NEAR(turned, 1.57, 0.05);
    }
    if (name == "highway.yaml") {
      EXPECT_NEAR(fastest, 15.0, 0.1);
    }
  }
}

TEST(SimulatedRun, APartKeepsTheWorldAndThePoses) {
  SceneOptions options;
  Load("traffic.yaml", &options);
  const SimulatedRun run = MakeRun(options);
  const SimulatedRun part = PartOf(run, FromSeconds(5.0), FromSeconds(3.0));
  EXPECT_EQ(part.duration, FromSeconds(3.0));
  EXPECT_EQ(part.T_world_cam(FromSeconds(1.0)).translation(), run.T_world_cam(FromSeconds(6.0)).translation());
  ASSERT_GT(run.scene->bodies.size(), 3u);
  for (std::size_t i = 0; i < run.scene->bodies.size(); ++i) {
    EXPECT_EQ(part.scene->bodies[i].T_world_body(0).translation(),
              run.scene->bodies[i].T_world_body(FromSeconds(5.0)).translation());
  }
  EXPECT_THROW(PartOf(run, FromSeconds(28.0), FromSeconds(3.0)), Error);
  EXPECT_THROW(PartOf(run, FromSeconds(28.0), 0), Error);
}

TEST(SimulatedRun, TheDavis346IsThatOfTheBundledCalibration) {
  const geometry::Calibration bundled =
      io::ReadCalibration(fs::path(EVO_SOURCE_DIR) / "configs/calibrations/mvsec_outdoor_day.yaml");
  const geometry::Calibration built_in = geometry::MvsecDavis346();
  EXPECT_EQ(bundled.fx, built_in.fx);
  EXPECT_EQ(bundled.cy, built_in.cy);
  EXPECT_EQ(bundled.coefficients, built_in.coefficients);
}

TEST(SimulatedRun, SamplesEndWithTheMotion) {
  const geometry::Trajectory poses = SamplePoses([](TimeNs) { return geometry::SE3(); }, 25'000'000, 100.0);
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_EQ(poses[2].t, 20'000'000);
  EXPECT_EQ(poses[3].t, 25'000'000);
}

TEST(SimulatedRun, RejectsOptionsThatDoNotFitTogether) {
  SceneOptions options;
  options.kind = "room";
  EXPECT_NE(Refusal(options, ErrorKind::kConfiguration).find("has no road"), std::string::npos);
  options.kind = "street";
  options.motion = "file";
  EXPECT_NE(Refusal(options, ErrorKind::kConfiguration).find("motion.file"), std::string::npos);
  options.motion_file = "no_such_file.txt";
  EXPECT_NE(Refusal(options, ErrorKind::kInput).find("no_such_file.txt"), std::string::npos);
  options.calibration = "no_such_camera.yaml";
  EXPECT_NE(Refusal(options, ErrorKind::kInput).find("no_such_camera.yaml"), std::string::npos);
}

TEST(SimulatedRun, FollowsATrajectoryFile) {
  const fs::path path = fs::temp_directory_path() / ("evo_motion_" + std::to_string(::getpid()) + ".txt");
  std::ofstream(path) << "5.0 1 0 0 0 0 0 1\n5.5 1 0 1 0 0 0 1\n6.0 1 0 2 0 0 0 1\n";
  SceneOptions options;
  options.kind = "room";
  options.motion = "file";
  options.motion_file = path;
  options.calibration = "davis240c";
  const SimulatedRun run = MakeRun(options);
  fs::remove(path);
  EXPECT_EQ(run.duration, FromSeconds(1.0));
  EXPECT_NEAR(run.T_world_cam(0).translation().norm(), 0.0, 1e-9);
  EXPECT_NEAR(run.T_world_cam(run.duration).translation().z(), 2.0, 1e-6);
  EXPECT_EQ(run.camera.width(), 240);
}

}  // namespace
}  // namespace evo::simulation
