// Scene, renderer and sensor together, without noise, against what theory says.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "evo/core/parallel.hpp"
#include "evo/core/random.hpp"
#include "evo/simulation/simulate.hpp"
#include "simulation/render_scene.hpp"
#include "simulation/sensor_stimulus.hpp"

namespace evo::simulation::test {
namespace {

class EventsOnly : public SimulationSink {
 public:
  void OnEvents(const events::EventColumns& block) override {
    for (std::size_t i = 0; i < block.size(); ++i) {
      events.push_back(block.t[i], block.x[i], block.y[i], block.polarity[i]);
    }
  }
  void OnImage(TimeNs, const events::GreyImage&, std::size_t) override {}
  void OnDepth(TimeNs, const events::DepthMap&) override {}
  events::EventColumns events;
};

SimulationOptions Fine() {
  SimulationOptions options;
  options.image_hz = 0.0;
  options.depth_hz = 0.0;
  return options;
}

events::EventColumns SimulateEvents(const SimulatedRun& run, const SensorOptions& sensor,
                                    const SimulationOptions& simulation) {
  SceneOptions options;
  options.sensor = sensor;
  options.simulation = simulation;
  ThreadPool pool(2);
  EventsOnly sink;
  Simulate(run, options, &pool, &sink);
  return sink.events;
}

/// Two plain halves of a wall, seen from a camera that moves sideways: their edge goes through the image to the left.
class MovingEdge : public ::testing::TestWithParam<std::pair<float, float>> {
 protected:
  static constexpr double kFocal = 60.0;
  static constexpr double kDepth = 2.0;
  static constexpr double kSpeed = 1.0;                                 // m/s
  static constexpr double kPixelsPerSecond = kFocal * kSpeed / kDepth;  // 30
  static constexpr double kEdge = 0.45;                                 // m, at the start: 13.5 px right of the axis

  MovingEdge() {
    const auto [left, right] = GetParam();
    scene.textures = {Plain(left), Plain(right)};
    scene.surfaces = {Facing(-9.0, kEdge, -9.0, 9.0, kDepth, 0), Facing(kEdge, 9.0, -9.0, 9.0, kDepth, 1)};
    options.samples = 8;  // an edge that crosses a pixel changes it in 64 steps
    options.max_step_px = 0.05;
  }

  /// When the edge has so far crossed pixel column x, of which `share` shows the right half then, s.
  double TimeOf(int x, double share) const {
    const double edge = camera.calibration().cx + kFocal * kEdge / kDepth;  // px, at the start
    return (edge - (x + 0.5 - share)) / kPixelsPerSecond;
  }

  Scene scene = Empty();
  const geometry::Camera camera{
      geometry::Calibration{geometry::Distortion::kRadTan, 24, 12, kFocal, kFocal, 8.0, 6.0, {}}};
  const PoseFunction motion = [](TimeNs t) {
    return geometry::SE3(Eigen::Quaterniond::Identity(), {kSpeed * ToSeconds(t), 0.0, 0.0});
  };
  SimulationOptions options = Fine();
};

TEST_P(MovingEdge, FiresAtTheClosedFormsTimesAndCounts) {
  const double before = GetParam().first;
  const double after = GetParam().second;
  const SensorOptions sensor = IdealSensor(0.3, 0.2);
  const double low = std::log(before + sensor.dark_radiance);
  const double change = std::log(after + sensor.dark_radiance) - low;
  const int sign = change > 0.0 ? 1 : -1;
  const double threshold = change > 0.0 ? sensor.threshold_on : sensor.threshold_off;
  const auto pixels =
      ByPixel(SimulateEvents({std::make_shared<Scene>(scene), camera, motion, FromSeconds(0.8)}, sensor, options));
  const int count = static_cast<int>(std::abs(change) / threshold);
  ASSERT_GE(count, 3);
  for (int x = 0; x <= 20; ++x) {  // the columns that the edge crosses whole
    for (int y = 0; y < camera.height(); ++y) {
      ASSERT_TRUE(pixels.contains({x, y})) << x << ", " << y;
      const PixelEvents& pixel = pixels.at({x, y});
      ASSERT_EQ(static_cast<int>(pixel.t.size()), count) << x << ", " << y;
      for (int k = 1; k <= count; ++k) {
        EXPECT_EQ(pixel.polarity[k - 1], sign);
        const double radiance = std::exp(low + sign * k * threshold) - sensor.dark_radiance;
        const double share = (radiance - before) / (after - before);
        EXPECT_NEAR(ToSeconds(pixel.t[k - 1]), TimeOf(x, share), 0.05 / kPixelsPerSecond) << x << ", " << y << " " << k;
      }
    }
  }
  for (const auto& [place, pixel] : pixels) EXPECT_LE(place.first, 21) << "where the edge has not been";
}

INSTANTIATE_TEST_SUITE_P(BrighterAndDarker, MovingEdge,
                         ::testing::Values(std::pair(0.2F, 0.7F), std::pair(0.9F, 0.3F)));

/// Walls and moving things all round, a camera that moves and turns: for every pixel the events add up to the change of
/// what the renderer shows there, but for less than a threshold.
TEST(SensorChain, IntegratedEventsEqualTheLogChangeOfTheFrames) {
  const Scene scene = [] {
    Scene random = RandomScene(60, 11);
    Random grey(4);
    random.textures.clear();
    for (int i = 0; i < 8; ++i) {
      std::vector<Texel> texels(64);
      for (auto& texel : texels) texel.reflectance = static_cast<float>(grey.Uniform(0.05, 0.95));
      random.textures.emplace_back(8, 8, texels);
    }
    for (auto& surface : random.surfaces) {
      surface.texture = grey.Index(8);
      surface.texels = {8.0, 8.0};
    }
    return random;
  }();
  const geometry::Camera camera(
      {geometry::Distortion::kRadTan, 48, 36, 40.0, 40.0, 24.0, 18.0, {-0.2, 0.03, 0.001, -0.001, 0.0}});
  const PoseFunction motion = [](TimeNs t) {
    const double s = ToSeconds(t);
    return geometry::SE3(geometry::so3::Exp({0.6 * s, -s, 0.8 * s}), {0.5 * s, 0.3 * s, 2.0 * s});
  };
  const TimeNs duration = FromSeconds(0.25);
  const SensorOptions sensor = IdealSensor(0.11, 0.07);
  const events::EventColumns events =
      SimulateEvents({std::make_shared<Scene>(scene), camera, motion, duration}, sensor, Fine());
  EXPECT_GT(events.size(), 10'000u);

  std::vector<double> sum(48 * 36);
  for (std::size_t i = 0; i < events.size(); ++i) {
    sum[static_cast<std::size_t>(events.y[i] * 48 + events.x[i])] +=
        events.polarity[i] > 0 ? sensor.threshold_on : -sensor.threshold_off;
  }
  const int samples = Fine().samples;
  const auto first = RenderAll(scene, camera, samples);
  const auto last = RenderAll(scene, camera, samples, duration, motion(duration));
  double largest = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double change = std::log(last[i] + sensor.dark_radiance) - std::log(first[i] + sensor.dark_radiance);
    largest = std::max(largest, std::abs(change));
    EXPECT_LT(change - sum[i], sensor.threshold_on + 1e-3) << i;
    EXPECT_GT(change - sum[i], -sensor.threshold_off - 1e-3) << i;
  }
  EXPECT_GT(largest, 10 * sensor.threshold_on);
}

}  // namespace
}  // namespace evo::simulation::test
