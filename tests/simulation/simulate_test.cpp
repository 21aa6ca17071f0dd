#include "evo/simulation/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "evo/core/parallel.hpp"
#include "evo/core/random.hpp"
#include "simulation/world/scene.hpp"

namespace evo::simulation {
namespace {

constexpr double kDistance = 2.0;  // m, of the wall
constexpr double kSpeed = 0.5;     // m/s, to the right
constexpr TimeNs kDuration = 100'000'000;

/// Everything that a simulation delivers.
class Record : public SimulationSink {
 public:
  void OnEvents(const events::EventColumns& block) override {
    for (std::size_t i = 0; i < block.size(); ++i) {
      events.push_back(block.t[i], block.x[i], block.y[i], block.polarity[i]);
    }
  }
  void OnImage(TimeNs t, const events::GreyImage& image, std::size_t before) override {
    image_stamps.push_back(t);
    images.push_back(image.grey);
    events_before.push_back(before);
  }
  void OnDepth(TimeNs t, const events::DepthMap& depth) override {
    depth_stamps.push_back(t);
    depth_maps.push_back(depth);
  }

  events::EventColumns events;
  std::vector<TimeNs> image_stamps;
  std::vector<std::vector<std::uint8_t>> images;
  std::vector<std::size_t> events_before;
  std::vector<TimeNs> depth_stamps;
  std::vector<events::DepthMap> depth_maps;
};

/// A wall of random blocks that fills the view.
Scene MakeWall() {
  Random random(5);
  std::vector<Texel> texels(64 * 64);
  for (auto& texel : texels) texel.reflectance = static_cast<float>(random.Uniform(0.1, 0.9));
  Scene scene;
  scene.textures.emplace_back(64, 64, texels);
  Surface wall;
  wall.origin = {-4.0, -4.0, kDistance};
  wall.edge_u = {8.0, 0.0, 0.0};
  wall.edge_v = {0.0, 8.0, 0.0};
  wall.texels = {80.0, 80.0};
  scene.surfaces.push_back(wall);
  scene.bodies.push_back({[](TimeNs) { return geometry::SE3(); }});
  return scene;
}

SensorOptions Noiseless() {
  SensorOptions options;
  options.threshold_spread = 0.0;
  options.leak_hz = 0.0;
  options.shot_noise_hz = 0.0;
  options.hot_pixels = 0.0;
  options.dead_pixels = 0.0;
  return options;
}

class SimulateTest : public ::testing::Test {
 protected:
  SimulationCounts Run(const SensorOptions& sensor, Record* record, int threads = 2) const {
    return Run({std::make_shared<Scene>(scene), camera, motion, kDuration}, sensor, record, threads);
  }
  SimulationCounts Run(const SimulatedRun& run, const SensorOptions& sensor, Record* record, int threads = 2) const {
    SceneOptions scene_options;
    scene_options.seed = 3;
    scene_options.sensor = sensor;
    scene_options.simulation = options;
    ThreadPool pool(threads);
    return Simulate(run, scene_options, &pool, record);
  }

  Scene scene = MakeWall();
  const geometry::Camera camera{geometry::Calibration{
      geometry::Distortion::kRadTan, 50, 40, 60.0, 60.0, 24.0, 20.0, {-0.1, 0.02, 0.0, 0.0, 0.0}}};
  PoseFunction motion = [](TimeNs t) {
    return geometry::SE3(Eigen::Quaterniond::Identity(), {kSpeed * ToSeconds(t), 0.0, 0.0});
  };
  SimulationOptions options;
};

TEST_F(SimulateTest, IsTheSameForAnyNumberOfThreads) {
  SensorOptions noisy;
  noisy.shot_noise_hz = 20.0;
  noisy.readout_row_s = 0.0002;
  Record one;
  const SimulationCounts counts = Run(noisy, &one, 1);
  EXPECT_GT(one.events.size(), 1000u);
  EXPECT_EQ(counts.events, one.events.size());
  for (const int threads : {2, 3}) {
    Record other;
    EXPECT_EQ(Run(noisy, &other, threads).pixel_renders, counts.pixel_renders);
    EXPECT_TRUE(one.events.t == other.events.t && one.events.x == other.events.x && one.events.y == other.events.y &&
                one.events.polarity == other.events.polarity);
    EXPECT_EQ(one.images, other.images);
    for (std::size_t i = 0; i < one.depth_maps.size(); ++i) {
      EXPECT_EQ(one.depth_maps[i].depth, other.depth_maps[i].depth);
    }
  }
}

TEST_F(SimulateTest, DeliversInOrderOfTimeThenRowThenColumn) {
  SensorOptions delayed = Noiseless();
  delayed.readout_row_s = 0.002;  // over the end of a slab
  options.image_hz = 70.0;
  Record record;
  Run(delayed, &record);
  const auto& events = record.events;
  for (std::size_t i = 1; i < events.size(); ++i) {
    ASSERT_LE(std::tie(events.t[i - 1], events.y[i - 1], events.x[i - 1]),
              std::tie(events.t[i], events.y[i], events.x[i]));
  }
  EXPECT_GE(events.t.front(), 0);
  EXPECT_LT(events.t.back(), kDuration);
  ASSERT_EQ(record.images.size(), 7u);
  for (std::size_t k = 0; k < record.images.size(); ++k) {
    EXPECT_EQ(record.image_stamps[k], std::llround(1e6 * static_cast<double>(k) / 70.0) * 1000);
    const auto before = std::ranges::lower_bound(events.t, record.image_stamps[k]) - events.t.begin();
    EXPECT_EQ(record.events_before[k], static_cast<std::size_t>(before));
  }
}

TEST_F(SimulateTest, ACameraAtRestHasNoEventsWithoutNoise) {
  motion = [](TimeNs) { return geometry::SE3(); };
  Record record;
  const SimulationCounts counts = Run(Noiseless(), &record);
  EXPECT_EQ(record.events.size(), 0u);
  EXPECT_EQ(counts.pixel_renders, 50u * 40u * 20u);  // every max_step_s
}

TEST_F(SimulateTest, RendersAsOftenAsTheMotionNeeds) {
  Record coarse;
  const SimulationCounts counts = Run(Noiseless(), &coarse);
  options.max_step_px = 0.125;
  Record fine;
  const SimulationCounts more = Run(Noiseless(), &fine);
  // 60 px * 0.5 m/s / 2 m = 15 px/s: every 5 ms that is under a tenth of a pixel.
  EXPECT_EQ(counts.pixel_renders, 50u * 40u * 20u);
  EXPECT_GE(more.pixel_renders, counts.pixel_renders);
  EXPECT_NEAR(static_cast<double>(fine.events.size()), static_cast<double>(coarse.events.size()),
              0.03 * static_cast<double>(coarse.events.size()));
}

/// Lamps before the wall, no other light; thresholds that the flicker alone crosses.
Lighting LampsAlone() {
  Lighting lighting;
  lighting.ambient = 0.0;
  lighting.sky = 0.0;
  lighting.lamps = {{{0.3, -0.5, 0.5}, 4.0}, {{-0.8, 0.4, 0.9}, 2.0}};
  return lighting;
}

/// log(1.5) - log(0.5) = 1.10 is crossed by three thresholds of 0.3 up and three down in each of twelve periods.
TEST_F(SimulateTest, LampsFlickerInFullBetweenFewRenders) {
  scene.lighting = LampsAlone();
  motion = [](TimeNs) { return geometry::SE3(); };
  SensorOptions sensor = Noiseless();
  sensor.threshold_on = 0.3;
  sensor.threshold_off = 0.3;
  sensor.bandwidth_hz = 0.0;
  sensor.refractory_s = 0.0;
  Record record;
  const SimulationCounts counts = Run(sensor, &record);
  EXPECT_EQ(counts.pixel_renders, 50u * 40u * 20u);
  std::vector<int> up(50 * 40), down(50 * 40);
  for (std::size_t i = 0; i < record.events.size(); ++i) {
    ++(record.events.polarity[i] > 0 ? up : down)[50 * record.events.y[i] + record.events.x[i]];
  }
  for (std::size_t p = 0; p < up.size(); ++p) {
    EXPECT_NEAR(up[p], 36, 1) << p;
    EXPECT_NEAR(down[p], 36, 1) << p;
  }
}

TEST_F(SimulateTest, FewRendersUnderLampsGiveTheEventsOfMany) {
  scene.lighting = LampsAlone();
  motion = [](TimeNs t) {
    return geometry::SE3(Eigen::Quaterniond::Identity(), {3.0 * ToSeconds(t), 0.0, 0.0});
  };  // 90 px/s
  SensorOptions sensor = Noiseless();
  sensor.threshold_on = 0.2;
  Record few;
  const SimulationCounts counts = Run(sensor, &few);
  options.max_step_s = 1.0 / 960.0;
  Record many;
  EXPECT_GT(Run(sensor, &many).pixel_renders, 4 * counts.pixel_renders);
  std::map<std::pair<int, int>, std::vector<TimeNs>> stamps;
  for (std::size_t i = 0; i < many.events.size(); ++i) {
    stamps[{many.events.x[i], many.events.y[i]}].push_back(many.events.t[i]);
  }
  // Each event has one of the reference at its pixel within a tenth of the flicker's period.
  std::size_t matched = 0;
  for (std::size_t i = 0; i < few.events.size(); ++i) {
    const auto& there = stamps[{few.events.x[i], few.events.y[i]}];
    const auto at = std::ranges::lower_bound(there, few.events.t[i] - 800'000);
    if (at != there.end() && *at < few.events.t[i] + 800'000) ++matched;
  }
  EXPECT_NEAR(static_cast<double>(few.events.size()), static_cast<double>(many.events.size()),
              0.005 * static_cast<double>(many.events.size()));
  EXPECT_GT(static_cast<double>(matched), 0.98 * static_cast<double>(few.events.size()));
}

TEST_F(SimulateTest, DepthAndPosesAgree) {
  motion = [](TimeNs t) {
    const double s = ToSeconds(t);
    return geometry::SE3(geometry::so3::Exp({0.5 * s, -s, 0.8 * s}), {kSpeed * s, 0.0, 3.0 * s});
  };
  options.depth_hz = 50.0;
  Record record;
  Run(Noiseless(), &record);
  ASSERT_EQ(record.depth_maps.size(), 5u);
  for (std::size_t k = 0; k < record.depth_maps.size(); ++k) {
    const geometry::SE3 T_world_cam = motion(record.depth_stamps[k]);
    for (int y = 0; y < camera.height(); y += 7) {
      for (int x = 0; x < camera.width(); x += 7) {
        const auto ray = camera.Undistort({x, y});
        ASSERT_TRUE(ray.has_value());
        const Eigen::Vector3d point = T_world_cam * (record.depth_maps[k].At(x, y) * ray->homogeneous());
        EXPECT_NEAR(point.z(), kDistance, 1e-4);
      }
    }
  }
}

TEST_F(SimulateTest, ALeadInSetsThePixelsAsTheWholeRunDoes) {
  constexpr TimeNs kLeadIn = 40'000'000;
  SensorOptions sensor;
  sensor.bandwidth_hz = 30.0;
  Record whole, part;
  const SimulatedRun run{std::make_shared<Scene>(scene), camera, motion, kLeadIn + kDuration};
  Run(run, sensor, &whole);
  options.lead_in_s = ToSeconds(kLeadIn);
  Run(PartOf(run, kLeadIn, kDuration), sensor, &part);
  const auto first =
      static_cast<std::size_t>(std::ranges::lower_bound(whole.events.t, kLeadIn) - whole.events.t.begin());
  ASSERT_GT(first, 100u);
  ASSERT_EQ(part.events.size(), whole.events.size() - first);
  for (std::size_t i = 0; i < part.events.size(); ++i) {
    ASSERT_EQ(part.events.t[i], whole.events.t[first + i] - kLeadIn) << i;
    ASSERT_EQ(part.events.x[i], whole.events.x[first + i]) << i;
    ASSERT_EQ(part.events.y[i], whole.events.y[first + i]) << i;
  }
  EXPECT_EQ(part.image_stamps.front(), 0);
}

/// The wall moves 15 px/s to the left: the second image is the first one, moved.
TEST_F(SimulateTest, ImagesShowWhatTheMotionPredicts) {
  options.image_hz = 15.0;  // 0 and 1/15 s: one pixel apart
  options.samples = 4;
  const geometry::Calibration ideal{geometry::Distortion::kRadTan, 50, 40, 60.0, 60.0, 24.0, 20.0, {}};
  Record record;
  Run({std::make_shared<Scene>(scene), geometry::Camera(ideal), motion, kDuration}, Noiseless(), &record);
  ASSERT_EQ(record.images.size(), 2u);
  int largest = 0;
  for (std::size_t y = 0; y < 40; ++y) {
    for (std::size_t x = 1; x < 50; ++x) {
      largest = std::max(largest, std::abs(record.images[0][50 * y + x] - record.images[1][50 * y + x - 1]));
    }
  }
  EXPECT_LE(largest, 4);  // the exposure adapts a little
  EXPECT_GT(*std::ranges::max_element(record.images[0]) - *std::ranges::min_element(record.images[0]), 50);
}

}  // namespace
}  // namespace evo::simulation
