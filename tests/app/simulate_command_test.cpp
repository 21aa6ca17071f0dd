// The files of evo-run simulate and their truth.
#include <cmath>
#include <vector>

#include "app/simulate.hpp"
#include "evo/core/random.hpp"
#include "evo/io/calibration_io.hpp"
#include "evo/io/track_io.hpp"
#include "io/hdf5/hdf5.hpp"
#include "simulation/render_scene.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

TEST_F(SimulateCommandTest, MvsecSequencesHaveTheDataSetsOfMvsec) {
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
TEST_F(SimulateCommandTest, RectifiedMapsFitAnIdealLens) {
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

TEST_F(SimulateCommandTest, ADrawnSceneLiesBesideItsSequenceAndSimulatesTheSame) {
  ASSERT_EQ(Run(Small("random", "a") + "--seed 3 --duration 0.05 -q"), 0) << err;
  EXPECT_EQ(ReadFile(folder / "a" / "scene.yaml").rfind("# Drawn from random.yaml by seed 3\n# drawn: sensor=", 0), 0u);
  ASSERT_EQ(Run("simulate " + Quote(folder / "a" / "scene.yaml") + " --duration 0.05 -q --out " + Quote(folder / "b")),
            0)
      << err;
  EXPECT_EQ(io::Sha256(folder / "a" / "random_data.hdf5"), io::Sha256(folder / "b" / "scene_data.hdf5"));
  EXPECT_EQ(io::Sha256(folder / "a" / "random_gt.hdf5"), io::Sha256(folder / "b" / "scene_gt.hdf5"));
  EXPECT_FALSE(fs::exists(folder / "b" / "scene.yaml")) << "nothing was drawn";
}

TEST_F(SimulateCommandTest, UzhSequencesHaveTheFilesOfUzh) {
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

/// True tracks of points of the scene, by single rays in double precision. A track begins where the neighbouring pixels
/// see the same surface and ends where another surface hides the point.
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

/// evaluate --tracks on tracks that are exact by construction.
TEST_F(SimulateCommandTest, TrueTracksOfTheSceneHaveNoError) {
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

}  // namespace
}  // namespace evo::app
