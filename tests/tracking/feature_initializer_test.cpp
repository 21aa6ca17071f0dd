#include "tracking/detection/feature_initializer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tracking/synthetic_events.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;
using evo::tracking::testing::CrossScene;
using evo::tracking::testing::SceneCamera;

constexpr TimeNs kStamp = 100'000'000;
const Vector2d kVelocity(90.0, 40.0);  // px/s

/// Crosses that are at their centres at kStamp.
struct MovingScene {
  CrossScene crosses{60, 11};
  events::EventHistory history{crosses.width, crosses.height};

  MovingScene() {
    history.Append(crosses.Events([](double t) { return Vector2d(kVelocity * (t - ToSeconds(kStamp))); }, 0.2, 1000.0));
  }

  std::vector<TrackedFeature> Initialize(const TrackerOptions& options, int threads = 1) const {
    const EgoMotion unknown(SceneCamera());
    ThreadPool pool(threads);
    FeatureInitializer initializer(crosses.width, crosses.height, options, unknown, &pool);
    std::vector<TrackedFeature> features;
    initializer.AddFeatures(history, kStamp, &features);
    return features;
  }
};

TEST(FeatureInitializer, FindsCrossesWithTheirFlow) {
  const MovingScene scene;
  const std::vector<TrackedFeature> features = scene.Initialize({});
  ASSERT_GE(features.size(), 5u);
  for (const auto& feature : features) {
    const auto distance = [&](const Vector2d& centre) { return (centre - feature.state.position).norm(); };
    EXPECT_LT(distance(*std::ranges::min_element(scene.crosses.centres, {}, distance)), 6.0);
    EXPECT_LT((feature.state.flow - kVelocity).norm(), 0.2 * kVelocity.norm());
    EXPECT_EQ(feature.state.filtered_position, feature.state.position);
    EXPECT_EQ(feature.window.measured_flow, feature.state.flow);
    EXPECT_EQ(feature.frames, 1);
    EXPECT_NEAR(feature.event_template.histogram().Total(), 1.0, 1e-5);
  }
}

TEST(FeatureInitializer, AddsNoMoreThanAreMissing) {
  TrackerOptions options;
  options.features = 2;
  options.uninformative_ratio = 0.0;
  EXPECT_EQ(MovingScene().Initialize(options).size(), 2u);
}

TEST(FeatureInitializer, RefusesTheLeastInformative) {
  TrackerOptions options;
  options.uninformative_ratio = 0.0;
  const MovingScene scene;
  const std::size_t all = scene.Initialize(options).size();
  options.uninformative_ratio = 0.5;
  EXPECT_EQ(scene.Initialize(options).size(), all - all / 2);
}

TEST(FeatureInitializer, CountsIdsOnAndKeepsTheSpacing) {
  const MovingScene scene;
  const EgoMotion unknown(SceneCamera());
  ThreadPool pool(1);
  FeatureInitializer initializer(scene.crosses.width, scene.crosses.height, {}, unknown, &pool);
  std::vector<TrackedFeature> features;
  initializer.AddFeatures(scene.history, kStamp, &features);
  initializer.AddFeatures(scene.history, kStamp, &features);
  for (std::size_t i = 0; i < features.size(); ++i) {
    EXPECT_EQ(features[i].id, static_cast<std::int64_t>(i));
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE((features[i].state.position - features[j].state.position).norm(),
                TrackerOptions().corner_min_spacing_px);
    }
  }
}

TEST(FeatureInitializer, FindsTheSameForAnyNumberOfThreads) {
  const MovingScene scene;
  const auto one = scene.Initialize({}, 1), three = scene.Initialize({}, 3);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].state.position, three[i].state.position);
}

}  // namespace
}  // namespace evo::tracking
