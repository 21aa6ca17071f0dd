#include "tracking/detection/flow_field.hpp"

#include <gtest/gtest.h>

#include "tracking/synthetic_events.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;

/// Ratio of the positions, 10 px apart, at which the field is within 10 % of `truth`.
double CorrectRatio(const FlowField& field, int width, int height, const Vector2d& truth) {
  int correct = 0, all = 0;
  for (int y = 10; y < height; y += 10) {
    for (int x = 10; x < width; x += 10, ++all) {
      correct += (field.Interpolate(Vector2d(x, y)) - truth).norm() < 0.1 * truth.norm() ? 1 : 0;
    }
  }
  return static_cast<double>(correct) / all;
}

TEST(FlowField, StartsFromThePredictionWhereNoFeatureIs) {
  const evo::tracking::testing::CrossScene scene(40, 2);
  const Vector2d velocity(1500.0, 875.0);
  const TrackerOptions options;
  events::EventHistory history(scene.width, scene.height);
  // Too fast to be found from rest.
  history.Append(scene.Events([&](double t) { return Vector2d(velocity * (t - 0.05)); }, 0.1, 500.0));
  ThreadPool pool(1);
  const auto ratio = [&](const FlowField::Prediction& predict) {
    FlowField field(scene.width, scene.height, options);
    field.Update(history, 50'000'000, {}, predict, &pool);
    return CorrectRatio(field, scene.width, scene.height, velocity);
  };
  EXPECT_LT(ratio([](const Vector2d&) { return std::nullopt; }), 0.5);
  EXPECT_GT(ratio([&](const Vector2d&) { return Vector2d(0.8 * velocity); }), 0.9);
}

TEST(FlowField, AveragesTheFlowOfFeaturesNearby) {
  const TrackerOptions options;
  const events::EventHistory history(120, 90);
  ThreadPool pool(1);
  FlowField field(120, 90, options);
  field.Update(
      history, 0, {{{30.0, 40.0}, {10.0, 0.0}}, {{34.0, 40.0}, {20.0, 0.0}}},
      [](const Vector2d&) { return std::nullopt; }, &pool);
  EXPECT_NEAR(field.Interpolate({32.0, 40.0}).x(), 15.0, 1.0);
}

}  // namespace
}  // namespace evo::tracking
