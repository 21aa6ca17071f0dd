#include "evo/simulation/scene_options.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "evo/core/error.hpp"

namespace evo {
namespace {

namespace fs = std::filesystem;

std::set<std::string> SceneFiles() {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(EVO_SOURCE_DIR) / "configs" / "scenes")) {
    names.insert(entry.path().filename());
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

TEST(SceneOptions, EveryBundledSceneCanBeMade) {
  const std::set<std::string> expected{"bumps.yaml",       "driving_day.yaml",    "driving_night.yaml",
                                       "highway.yaml",     "handheld_boxes.yaml", "slider.yaml",
                                       "stop_and_go.yaml", "traffic.yaml",        "turns.yaml"};
  EXPECT_EQ(SceneFiles(), expected);
  for (const auto& name : SceneFiles()) {
    SceneOptions options;
    ASSERT_NO_THROW(Load(name, &options)) << name;
    const SimulatedRun run = MakeRun(options);
    EXPECT_GT(run.scene.surfaces.size(), 3u) << name;
    EXPECT_FALSE(run.scene.bodies.empty()) << name;
    EXPECT_GE(run.duration, FromSeconds(2.0)) << name;
    EXPECT_TRUE(run.motion(run.duration).translation().allFinite()) << name;
  }
}

TEST(SceneOptions, DrivingDayIsThePapersRun) {
  SceneOptions options;
  Load("driving_day.yaml", &options);
  const SimulatedRun run = MakeRun(options);
  EXPECT_EQ(run.duration, FromSeconds(60.0));
  const Trajectory poses = Sample(run.motion, run.duration, 20.0);
  ASSERT_EQ(poses.size(), 1201u);
  double length = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].t - poses[i - 1].t, 50'000'000);
    length += (poses[i].T_world_cam.translation() - poses[i - 1].T_world_cam.translation()).norm();
  }
  EXPECT_NEAR(length, 440.0, 10.0);
}

TEST(SceneOptions, SamplesEndWithTheMotion) {
  const Trajectory poses = Sample([](TimeNs) { return SE3(); }, 25'000'000, 100.0);
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_EQ(poses[2].t, 20'000'000);
  EXPECT_EQ(poses[3].t, 25'000'000);
}

TEST(SceneOptions, RefusesWhatDoesNotFitTogether) {
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

TEST(SceneOptions, FollowsAMotionFromAFile) {
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
  EXPECT_NEAR(run.motion(0).translation().norm(), 0.0, 1e-9);
  EXPECT_NEAR(run.motion(run.duration).translation().z(), 2.0, 1e-6);
  EXPECT_EQ(run.camera.width(), 240);
}

}  // namespace
}  // namespace evo
