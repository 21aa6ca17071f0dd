#include "tracking/patch/em_flow.hpp"

#include <gtest/gtest.h>

#include "tracking/detection/flow_estimation.hpp"
#include "tracking/patch_events.hpp"
#include "tracking/synthetic_events.hpp"

namespace evo::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using testing::PatchEvents;

TEST(FlowEstimator, RefinesAnApproximateFlow) {
  for (const Vector2d& truth : {Vector2d(150, 40), Vector2d(-80, -160), Vector2d(0, 30)}) {
    const double half_window = 2.0 / truth.norm();
    const events::LocalEvents events =
        PatchEvents({Vector2d::Zero(), truth, Matrix2d::Identity()}, half_window, 400, 5);
    FlowEstimator estimator(17, 2, {1.0, 1.5, 0.2, 50});
    Vector2d flow = 0.6 * truth;
    const double inlier_ratio = estimator.Refine(events, half_window, &flow);
    EXPECT_GT(inlier_ratio, 0.7);
    EXPECT_LT((flow - truth).norm(), 0.08 * truth.norm()) << truth.transpose();
  }
}

TEST(FlowEstimator, CoarseCellsComeNear) {
  for (int seed = 1; seed <= 5; ++seed) {
    const Vector2d truth(120, -60);
    const double half_window = 2.0 / truth.norm();
    const events::LocalEvents events =
        PatchEvents({Vector2d::Zero(), truth, Matrix2d::Identity()}, half_window, 400, static_cast<unsigned>(seed));
    FlowEstimator estimator(17, 2, {2.0, 1.5, 0.2, 50});
    Vector2d flow = 0.5 * truth;
    estimator.Refine(events, half_window, &flow);
    EXPECT_LT((flow - truth).norm(), 0.2 * truth.norm()) << seed;
  }
}

TEST(EstimateFlow, FindsSlowAndFastFlowsFromZero) {
  const testing::CrossScene scene(60, 11);
  const TrackerOptions options;
  for (const Vector2d& truth : {Vector2d(30, -10), Vector2d(120, 60), Vector2d(-350, 100)}) {
    events::EventHistory history(scene.width, scene.height);
    history.Append(scene.Events([&](double t) { return Vector2d(truth * (t - 0.1)); }, 0.2, 1000.0));
    int good = 0;
    int estimated = 0;
    for (int x = 25; x < scene.width - 20; x += 8) {
      for (int y = 25; y < scene.height - 20; y += 8) {
        Vector2d flow = Vector2d::Zero();
        if (!EstimateFlow(history, 100'000'000, Vector2d(x, y), options, &flow)) continue;
        ++estimated;
        // The arms of a slow cross stay in one row of pixels for most of a window, which costs some px/s.
        if ((flow - truth).norm() < 0.12 * truth.norm() + 8.0) ++good;
      }
    }
    EXPECT_GE(estimated, 10);
    EXPECT_GE(good, 0.9 * estimated) << truth.transpose();
  }
}

TEST(EstimateFlow, FailsWithoutEvents) {
  const events::EventHistory history(50, 50);
  Vector2d flow = Vector2d::Zero();
  EXPECT_FALSE(EstimateFlow(history, 0, {25.0, 25.0}, TrackerOptions{}, &flow));
}

}  // namespace
}  // namespace evo::tracking
