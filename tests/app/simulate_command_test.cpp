// evo-run simulate: what it writes, that it is true, and what is left when it fails.
#include <fcntl.h>

#include <cmath>
#include <map>
#include <vector>

#include "app/evo_run.hpp"
#include "evo/io/calibration_io.hpp"
#include "evo/io/checksum.hpp"
#include "evo/io/depth_maps.hpp"
#include "evo/io/tracks.hpp"
#include "evo/io/trajectory_io.hpp"
#include "evo/simulation/scene_options.hpp"
#include "io/hdf5.hpp"
#include "simulation/render_scene.hpp"

namespace evo {
namespace {

namespace fs = std::filesystem;

constexpr char kSmallCamera[] =
    "cam0:\n  camera_model: pinhole\n  intrinsics: [90, 90, 60, 45]\n  distortion_model: radtan\n"
    "  distortion_coeffs: [-0.2, 0.05, 0.001, -0.001]\n  resolution: [120, 90]\n";

class SimulateCommandTest : public EvoRunTest {
 protected:
  static fs::path SceneFile(const std::string& name) { return fs::path(EVO_SOURCE_DIR) / "configs" / "scenes" / name; }

  /// Shell words for a bundled scene, seen by a small camera.
  std::string Small(const std::string& scene, const std::string& result) const {
    return "simulate " + Quote(SceneFile(scene + ".yaml")) +
           " --set scene.calibration=" + Quote(Write("camera.yaml", kSmallCamera)) + " --out " +
           Quote(folder / result) + " ";
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
      if (entry.is_regular_file() && name != "manifest.json") sums[name] = Sha256(entry.path());
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
  const hdf5::File data(folder / "a" / "slider_data.hdf5");
  const hdf5::File truth(folder / "a" / "slider_gt.hdf5");
  const auto shape = [](const hdf5::File& file, const std::string& name) { return file.Open("davis/left/" + name).shape(); };
  using Shape = std::vector<hsize_t>;
  EXPECT_EQ(shape(data, "image_raw"), (Shape{3, 90, 120}));
  EXPECT_EQ(shape(data, "image_raw_ts"), (Shape{3}));
  EXPECT_EQ(shape(data, "image_raw_event_inds"), (Shape{3}));
  EXPECT_EQ(shape(data, "events").at(1), 4u);
  for (const char* poses : {"odometry", "pose"}) EXPECT_EQ(shape(truth, poses), (Shape{25, 4, 4}));
  for (const char* maps : {"depth_image_raw", "depth_image_rect"}) EXPECT_EQ(shape(truth, maps), (Shape{3, 90, 120}));
  EXPECT_EQ(shape(truth, "flow_dist"), (Shape{2, 2, 90, 120}));
  EXPECT_EQ(shape(truth, "flow_dist_ts"), (Shape{2}));
  EXPECT_EQ(ReadCalibration(folder / "a" / "camchain-imucam-slider.yaml").width, 120);
}

TEST_F(SimulateCommandTest, UzhSequencesHoldWhatThePublishedOnesDo) {
  ASSERT_EQ(Run(Small("slider", "u") + "--format uzh --duration 0.12 --preview-every 0.1"), 0) << err;
  for (const char* name :
       {"events.txt", "groundtruth.txt", "calib.txt", "images.txt", "images/frame_00000002.png", "depth_gt.hdf5",
        "preview/frame_0000.100s.png", "manifest.json"}) {
    EXPECT_TRUE(fs::exists(folder / "u" / name)) << name;
  }
  EXPECT_EQ(CountFiles(folder / "u"), 11);
  EXPECT_EQ(Run("info " + Quote(folder / "u")), 0) << err;
  EXPECT_EQ(Run("info " + Quote(folder / "u" / "depth_gt.hdf5")), 0) << err;
  EXPECT_NE(out.find("3 of 120 x 90 px"), std::string::npos) << out;
}

TEST_F(SimulateCommandTest, SameBytesForAnyNumberOfThreads) {
  ExpectSameBytesForAnyThreads(Small("driving_night", "result") + "--duration 0.06 ");
}

TEST_F(SimulateCommandTest, SameTextForAnyNumberOfThreads) {
  ExpectSameBytesForAnyThreads(Small("handheld_boxes", "result") + "--format uzh --duration 0.11 ");
}

/// The oracle of evaluate --tracks against points of the scene whose places are known from its making: tracks that
/// follow them exactly, as long as nothing hides them, have no error and their full age.
TEST_F(SimulateCommandTest, PointsOfTheSceneAreTracksWithoutError) {
  ASSERT_EQ(Run(Small("handheld_boxes", "room") + "--duration 1.6 --set output.start_s=0"), 0) << err;
  SceneOptions options;
  Parameters parameters;
  Register(parameters, options);
  parameters.LoadFile(SceneFile("handheld_boxes.yaml"));
  options.calibration = Path("camera.yaml");
  const SimulatedRun run = MakeRun(options);
  Random random(3);
  Tracks tracks;
  for (int id = 0; id < 150; ++id) {
    const int index = random.Index(static_cast<int>(run.scene.surfaces.size()));
    const Surface& surface = run.scene.surfaces[static_cast<std::size_t>(index)];
    const double a = random.Uniform(0.0, 1.0);
    const Eigen::Vector3d point = surface.origin + a * surface.edge_u + random.Uniform(0.0, 1.0) * surface.edge_v;
    for (TimeNs t = 0; t <= FromSeconds(1.55); t += 15'500'000) {
      const SE3 T_world_cam = run.motion(t);
      const Eigen::Vector3d seen = T_world_cam.Inverse() * point;
      if (!(seen.z() > 0.1)) break;
      const Eigen::Vector2d pixel = run.camera.Project(seen);
      const auto ray = run.camera.Contains(pixel) ? run.camera.Undistort(pixel) : std::nullopt;
      if (!ray || CastRay(run.scene, *ray, t, T_world_cam).surface != index) break;
      tracks.push_back({id, t, pixel.x(), pixel.y()});
    }
  }
  WriteTracks(folder / "tracks.txt", tracks);
  ASSERT_EQ(Run("evaluate --no-plots --tracks " + Quote(folder / "tracks.txt") + " --ground-truth " +
                Quote(folder / "room" / "handheld_boxes_gt.hdf5") + " --calibration " + Quote(folder / "camera.yaml") +
                " --out " + Quote(folder / "quality")),
            0)
      << err;
  printf("%s", out.c_str());
  printf("%s", ReadFile(folder / "quality" / "track_quality.csv").substr(0, 3000).c_str());
}

}  // namespace
}  // namespace evo
