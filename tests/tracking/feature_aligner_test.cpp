#include "tracking/feature_aligner.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tracking/detection/feature_initializer.hpp"
#include "tracking/synthetic_events.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;
using State = FeatureAlignment::State;
using evo::tracking::testing::CrossScene;
using evo::tracking::testing::SceneCamera;

constexpr TimeNs kStamp = 100'000'000;
constexpr double kStepS = 0.02;
constexpr TimeNs kNext = kStamp + 20'000'000;
const Vector2d kVelocity(90.0, 40.0);  // px/s

class FeatureAlignerTest : public ::testing::Test {
 protected:
  FeatureAlignerTest() {
    history.Append(scene.Events([](double t) { return Vector2d(kVelocity * (t - ToSeconds(kStamp))); }, 0.2, 1000.0));
    ThreadPool pool(1);
    FeatureInitializer initializer(scene.width, scene.height, options, ego_motion, &pool);
    initializer.AddFeatures(history, kStamp, &features);
  }

  FeatureAlignment Align(const TrackedFeature& feature, const events::EventHistory& events,
                         const RotationCorrection& correction = {}) const {
    FeatureAlignment alignment;
    FeatureAligner(options, ego_motion).Align(events, kNext, kStepS, correction, feature, &alignment);
    return alignment;
  }

  CrossScene scene{60, 11};
  TrackerOptions options;
  EgoMotion ego_motion{SceneCamera()};
  events::EventHistory history{scene.width, scene.height};
  events::EventHistory empty{scene.width, scene.height};
  std::vector<TrackedFeature> features;
};

TEST_F(FeatureAlignerTest, FollowsTheMotionOfTheScene) {
  std::vector<double> errors;
  for (const auto& feature : features) {
    const FeatureAlignment alignment = Align(feature, history);
    if (!alignment.is_aligned()) continue;
    errors.push_back((alignment.Position() - feature.state.position - kStepS * kVelocity).norm());
    EXPECT_LT(alignment.outlier_ratio, 0.7);
  }
  ASSERT_GE(errors.size(), 4u);
  std::ranges::sort(errors);
  EXPECT_LT(errors[errors.size() / 2], 0.2);
}

TEST_F(FeatureAlignerTest, AddsTheCorrectionToThePrediction) {
  const RotationCorrection correction{.rotation = {0.0, 0.002, 0.0}, .angular_velocity = {0.0, 0.01, 0.0}};
  const FeatureAlignment plain = Align(features.front(), history);
  const FeatureAlignment corrected = Align(features.front(), history, correction);
  // The focal length is 1000 px.
  EXPECT_NEAR((corrected.predicted_position - plain.predicted_position).x(), 2.0, 0.05);
  EXPECT_NEAR((corrected.predicted.flow - plain.predicted.flow).x(), 10.0, 0.2);
}

TEST_F(FeatureAlignerTest, LosesAFeatureWithoutEventsUnlessItRests) {
  TrackedFeature feature = features.front();
  feature.frames = 100;
  EXPECT_EQ(Align(feature, empty).state, State::kLost);
  feature.state.flow = {10.0, 0.0};
  const FeatureAlignment resting = Align(feature, empty);
  EXPECT_EQ(resting.state, State::kResting);
  EXPECT_NEAR((resting.Position() - feature.state.position - Vector2d(0.2, 0.0)).norm(), 0.0, 1e-9);
  feature.frames = 2;
  EXPECT_EQ(Align(feature, empty).state, State::kLost) << "a new feature must show itself";
}

}  // namespace
}  // namespace evo::tracking
