#include "tracking/smoothing/rotation_spline.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "evo/geometry/known_cameras.hpp"
#include "evo/geometry/se3.hpp"
#include "tracking/smoothing/track_buffer.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSensorBlurS = 0.016;

/// Distant points, observed by a camera that rotates slowly and vibrates. Each position is the mean, and each flow the
/// slope, over a window. The sensor blurs positions like a longer window.
struct VibratingTracks {
  geometry::Camera camera{geometry::MvsecDavis346()};
  double amplitude_rad = 0.002;
  double frequency_hz = 12.0;
  events::Tracks smoothed, exact;
  std::vector<ObservedWindow> windows;

  Vector3d Rotation(double t) const {
    const double vibration = amplitude_rad * std::sin(2.0 * M_PI * frequency_hz * t);
    return {0.004 * std::sin(2.0 * t) + vibration, 0.02 * t + 0.5 * vibration, 0.0};
  }

  explicit VibratingTracks(double noise_px, double amplitude = 0.002, double frame_s = 0.02, double duration_s = 8.0)
      : amplitude_rad(amplitude) {
    std::mt19937 random(7);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
    std::vector<Vector3d> rays;
    for (int i = 0; i < 40; ++i) {
      rays.push_back(camera.Undistort({30.0 + 280.0 * uniform(), 30.0 + 200.0 * uniform()})->homogeneous());
    }
    for (int frame = 0; frame < static_cast<int>(duration_s / frame_s); ++frame) {
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const double t = frame * frame_s;
        const double half = i % 2 ? 0.04 : 0.005;
        Vector2d mean = Vector2d::Zero(), slope = Vector2d::Zero();
        constexpr int kSteps = 40;
        for (int k = 0; k < kSteps; ++k) {
          const double phase = (k + 0.5) * 2.0 / kSteps - 1.0;
          const auto seen = [&](double reach) {
            return camera.Project(geometry::so3::Exp(Rotation(t + reach * phase)) * rays[i]);
          };
          mean += seen(std::hypot(half, kSensorBlurS)) / kSteps;
          slope += 3.0 * phase / half * seen(half) / kSteps;
        }
        mean += noise_px * Vector2d(uniform() - 0.5, uniform() - 0.5);
        slope += noise_px / half * Vector2d(uniform() - 0.5, uniform() - 0.5);
        const Vector2d now = camera.Project(geometry::so3::Exp(Rotation(t)) * rays[i]);
        smoothed.push_back({static_cast<std::int64_t>(i), FromSeconds(t), mean.x(), mean.y()});
        exact.push_back({static_cast<std::int64_t>(i), FromSeconds(t), now.x(), now.y()});
        windows.push_back({static_cast<float>(half), slope.cast<float>()});
      }
    }
  }

  /// Root mean square over the tracks with long windows.
  double Error(const events::Tracks& tracks, double from_s = 0.0, double to_s = 1e9) const {
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      const double t = ToSeconds(tracks[i].t);
      if (windows[i].half_s < 0.02f || t < from_s || t >= to_s) continue;
      sum += std::pow(tracks[i].x - exact[i].x, 2) + std::pow(tracks[i].y - exact[i].y, 2);
      ++count;
    }
    return std::sqrt(sum / count);
  }
};

/// All observations, as one segment.
events::Tracks Restored(const VibratingTracks& scene) {
  events::Tracks restored = scene.smoothed;
  RestoreRotation(scene.camera, JacobianTable(scene.camera), scene.smoothed, scene.windows, 0, restored);
  return restored;
}

/// All observations, frame by frame through a buffer.
events::Tracks RestoredByBuffer(const geometry::Camera& camera, const events::Tracks& smoothed,
                                std::span<const ObservedWindow> windows, int threads) {
  ThreadPool pool(threads);
  events::Tracks restored;
  TrackBuffer buffer(camera, {}, &pool,
                     [&](const events::Tracks& next) { restored.insert(restored.end(), next.begin(), next.end()); });
  for (std::size_t i = 0, end = 0; i < smoothed.size(); i = end) {
    while (end < smoothed.size() && smoothed[end].t == smoothed[i].t) ++end;
    const auto frame = std::span(smoothed).subspan(i, end - i);
    buffer.Add(smoothed[i].t, events::Tracks(frame.begin(), frame.end()), windows.subspan(i, end - i), {});
  }
  buffer.Finish();
  return restored;
}

TEST(RestoreRotation, RestoresWhatLongWindowsAverageAway) {
  const VibratingTracks scene(0.1);
  EXPECT_GT(scene.Error(scene.smoothed), 0.25);
  EXPECT_LT(scene.Error(Restored(scene)), 0.4 * scene.Error(scene.smoothed));
}

TEST(RestoreRotation, WorksWithShortFrames) {
  for (const double frame_s : {0.005, 0.01, 0.025}) {
    const VibratingTracks scene(0.1, 0.002, frame_s);
    EXPECT_LT(scene.Error(Restored(scene)), 0.55 * scene.Error(scene.smoothed)) << frame_s;
  }
}

TEST(RestoreRotation, WorksThroughABufferForAnyNumberOfThreads) {
  const VibratingTracks scene(0.1, 0.002, 0.02, 24.0);
  const events::Tracks one = RestoredByBuffer(scene.camera, scene.smoothed, scene.windows, 1);
  const events::Tracks three = RestoredByBuffer(scene.camera, scene.smoothed, scene.windows, 3);
  ASSERT_EQ(one.size(), scene.smoothed.size());
  EXPECT_TRUE(one == three);
  for (double from = 0.0; from < 24.0; from += 2.5) {  // also where segments meet
    EXPECT_LT(scene.Error(one, from, from + 2.5), 0.5 * scene.Error(scene.smoothed, from, from + 2.5)) << from;
  }
}

TEST(RestoreRotation, LeavesUninformativeTracksUnchanged) {
  const VibratingTracks slow(0.1, 0.002, 0.04);
  EXPECT_TRUE(Restored(slow) == slow.smoothed);
  // A gap of an hour, equal stamps, a window longer than any.
  const TimeNs hour = 3600 * kNsPerSecond;
  const events::Tracks few = {{1, 0, 100, 100}, {1, 0, 101, 100}, {1, hour, 102, 100}, {2, hour, 5, 5}};
  const std::vector<ObservedWindow> windows(few.size(), {1.0f, {50.0f, 0.0f}});
  const events::Tracks restored = RestoredByBuffer(slow.camera, few, windows, 1);
  ASSERT_EQ(restored.size(), 3u);  // a feature observed once is dropped
  EXPECT_EQ(restored[2].x, 102);
}

TEST(RestoreRotation, AcceptsFramesCloserThanTheFirstTwo) {
  // Differences over a fraction of a knot then end at the last one.
  VibratingTracks scene(0.1, 0.002, 0.001, 0.2);
  for (auto& observation : scene.smoothed) {
    if (observation.t == 0) observation.t -= 19'000'000;
  }
  const events::Tracks restored = Restored(scene);
  EXPECT_LT(scene.Error(restored, 0.001), 2.0 * scene.Error(scene.smoothed, 0.001));
}

TEST(RestoreRotation, HardlyDisturbsASteadyCamera) {
  const VibratingTracks scene(0.1, 0.0);
  EXPECT_LT(scene.Error(Restored(scene)), scene.Error(scene.smoothed) + 0.02);
}

TEST(RestoreRotation, LeavesInstantsUnchanged) {
  VibratingTracks scene(0.1);
  scene.windows.assign(scene.windows.size(), {});
  EXPECT_TRUE(Restored(scene) == scene.smoothed);
  RestoreRotation(scene.camera, JacobianTable(scene.camera), {}, {}, 0, {});
}

}  // namespace
}  // namespace evo::tracking
