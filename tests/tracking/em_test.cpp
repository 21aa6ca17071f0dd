#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "tracking/detection/flow_field.hpp"
#include "tracking/patch/em_affine.hpp"
#include "tracking/patch/em_flow.hpp"
#include "tracking/synthetic_events.hpp"

namespace evo::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// Events of edges near the centre under a known motion of the patch, with pixel noise.
events::LocalEvents PatchEvents(const PatchMotion& motion, double half_window_s, int count, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  const Vector2d corners[] = {{-9, -7}, {8, -9}, {10, 6}, {-6, 9}, {0, 1}, {3, -2}};
  events::LocalEvents events;
  for (int i = 0; i < count; ++i) {
    const int edge = static_cast<int>(uniform() * 5.0);
    const Vector2d u = corners[edge] + uniform() * (corners[edge + 1] - corners[edge]);
    const double dt = half_window_s * (2.0 * uniform() - 1.0);
    const Vector2d x = motion.offset + motion.flow * dt + motion.linear * u;
    events.x.push_back(static_cast<float>(x.x() + 0.6 * (uniform() - 0.5)));
    events.y.push_back(static_cast<float>(x.y() + 0.6 * (uniform() - 0.5)));
    events.dt.push_back(static_cast<float>(dt));
    events.polarity.push_back(edge % 2 ? 1 : -1);
  }
  return events;
}

DensityMap TemplateOf(const events::LocalEvents& events) {
  DensityMap map(19, 2);
  for (std::size_t i = 0; i < events.size(); ++i) {
    map.Vote(events.x[i], events.y[i], map.PlaneOf(events.polarity[i]), 1.0f);
  }
  return map;
}

TEST(FlowEstimator, RefinesAFlowThatMovesThePatchAFewPixels) {
  for (const Vector2d& truth : {Vector2d(150, 40), Vector2d(-80, -160), Vector2d(0, 30)}) {
    const double half_window = 2.0 / truth.norm();
    const events::LocalEvents events =
        PatchEvents({Vector2d::Zero(), truth, Matrix2d::Identity()}, half_window, 400, 5);
    FlowEstimator estimator(17, 2, {1.0, 1.5, 0.2, 50});
    Vector2d flow = 0.6 * truth;
    const double share = estimator.Refine(events, half_window, &flow);
    EXPECT_GT(share, 0.7);
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

TEST(EstimateFlow, FindsSlowAndFastFlowsFromNothing) {
  const evo::tracking::testing::CrossScene scene(60, 11);
  const TrackerOptions options;
  for (const Vector2d& truth : {Vector2d(30, -10), Vector2d(120, 60), Vector2d(-350, 100)}) {
    events::EventHistory history(scene.width, scene.height);
    history.Append(scene.Events([&](double t) { return Vector2d(truth * (t - 0.1)); }, 0.2, 1000.0));
    int good = 0;
    int estimated = 0;
    for (int x = 25; x < scene.width - 20; x += 8) {
      for (int y = 25; y < scene.height - 20; y += 8) {
        Vector2d flow = Vector2d::Zero();
        if (!EstimateFlow(history, 100'000'000, x, y, options, &flow)) continue;
        ++estimated;
        // Slow arms of a cross stay in their row of pixels for most of a window: some px/s are beyond reach.
        if ((flow - truth).norm() < 0.12 * truth.norm() + 8.0) ++good;
      }
    }
    EXPECT_GE(estimated, 10);
    EXPECT_GE(good, 0.9 * estimated) << truth.transpose();
  }
}

TEST(EstimateFlow, SaysWhereThereIsNothing) {
  const events::EventHistory history(50, 50);
  Vector2d flow = Vector2d::Zero();
  EXPECT_FALSE(EstimateFlow(history, 0, 25, 25, TrackerOptions{}, &flow));
}

TEST(AlignToTemplate, RecoversAKnownAffineMotion) {
  const DensityMap map = TemplateOf(PatchEvents({}, 0.01, 2000, 1));
  AssociationField coarse, fine;
  coarse.Build(map, 2.5, 0.2);
  fine.Build(map, 1.0, 0.2);
  PatchMotion truth;
  truth.offset = {1.7, -1.1};
  truth.flow = {90, -40};
  truth.linear << 1.06, 0.02, -0.03, 1.04;
  const events::LocalEvents events = PatchEvents(truth, 0.02, 600, 2);

  PatchMotion motion;
  motion.flow = {80, -30};
  AlignmentOptions options{20, 15.0, 0.02, 5.0, 5.0, coarse.OwnMoments(map, Matrix2d::Identity(), 15.0)};
  AlignToTemplate(events, coarse, 2, options, false, &motion);
  options.iterations = 50;
  options.own_moments = fine.OwnMoments(map, Matrix2d::Identity(), 15.0);
  const AlignmentQuality quality = AlignToTemplate(events, fine, 2, options, true, &motion);
  EXPECT_GT(quality.inlier_share, 0.7);
  EXPECT_LT(quality.residual_px, 1.0);
  EXPECT_LT((motion.offset - truth.offset).norm(), 0.15);
  EXPECT_LT((motion.flow - truth.flow).norm(), 12.0);
  EXPECT_LT((motion.linear - truth.linear).norm(), 0.04);
}

TEST(TemplatePoints, UndoTheMotionThatTheyAreGiven) {
  PatchMotion motion;
  motion.offset = {1.2, -0.7};
  motion.flow = {90, -40};
  motion.linear << 1.2, 0.1, -0.05, 1.1;
  motion.perspective = {0.01, -0.015};
  motion.rate << 2.0, 0.3, -0.2, 1.5;
  motion.bend = {0.02, 0.03};
  events::LocalEvents events;
  std::vector<Vector2d> truth;
  const double dt = 0.01;
  for (int x = -8; x <= 8; x += 4) {
    for (int y = -8; y <= 8; y += 4) {
      const Vector2d u(x, y);
      const Vector2d at_reference = motion.linear * u / (1.0 + motion.perspective.dot(u));
      const Vector2d moving = motion.rate * at_reference + motion.bend.dot(at_reference) * at_reference;
      const Vector2d seen = motion.offset + motion.flow * dt + at_reference + moving * dt;
      events.x.push_back(static_cast<float>(seen.x()));
      events.y.push_back(static_cast<float>(seen.y()));
      events.dt.push_back(static_cast<float>(dt));
      events.polarity.push_back(1);
      truth.push_back(u);
    }
  }
  TemplatePoints points;
  points.Update(events, motion);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // To the first order in dt, as a window of some 10 ms needs.
    EXPECT_NEAR(points.u[i], truth[i].x(), 0.02) << truth[i].transpose();
    EXPECT_NEAR(points.v[i], truth[i].y(), 0.02) << truth[i].transpose();
  }
}

TEST(AlignToTemplate, OneStepIsTheLeastSquaresOfThePulls) {
  const DensityMap map = TemplateOf(PatchEvents({}, 0.01, 2000, 1));
  AssociationField field;
  field.Build(map, 1.0, 0.2);
  PatchMotion truth;
  truth.offset = {0.7, -0.4};
  truth.flow = {40, -30};
  const events::LocalEvents events = PatchEvents(truth, 0.02, 611, 2);
  PatchMotion motion;
  motion.flow = {35, -25};
  motion.perspective = {0.004, -0.002};
  motion.rate << 1.0, 0.1, -0.2, 0.8;
  TemplatePoints points;
  points.Update(events, motion);
  Eigen::Matrix4d normal = Eigen::Vector4d(0.0, 20.0, 10.0, 10.0).asDiagonal();
  Eigen::Matrix<double, 4, 2> right = Eigen::Matrix<double, 4, 2>::Zero();
  double all = 0.0, inliers = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Eigen::Vector4d row(1.0, events.dt[i] / 0.02, points.u[i] / 15.0, points.v[i] / 15.0);
    const Eigen::Array4d pull = field.At(points.u[i], points.v[i], events.polarity[i] < 0 ? 1 : 0).cast<double>();
    normal += pull[0] * row * row.transpose();
    right += row * Eigen::RowVector2d(pull[1], pull[2]);
    inliers += pull[0];
    all += pull[3];
    if (pull[0] > 0.0) squares += (pull[1] * pull[1] + pull[2] * pull[2]) / pull[0];
  }
  const Eigen::Matrix<double, 4, 2> step = 1.5 * normal.inverse() * right;
  const AlignmentQuality quality = AlignToTemplate(events, field, 2, {1, 15.0, 0.02, 20.0, 10.0}, true, &motion);
  EXPECT_NEAR(quality.inlier_share, inliers / all, 1e-4);
  EXPECT_NEAR(quality.residual_px, std::sqrt(squares / inliers), 1e-4);
  Matrix2d linear;
  linear << step(2, 0), step(3, 0), step(2, 1), step(3, 1);
  linear = (Matrix2d::Identity() + linear / 15.0).inverse().eval();
  EXPECT_GT(step.row(0).norm(), 0.1);
  EXPECT_LT((motion.linear - linear).norm(), 1e-4);
  EXPECT_LT((motion.offset + linear * step.row(0).transpose()).norm(), 1e-4);
  EXPECT_LT((motion.flow - Vector2d(35, -25) + linear * step.row(1).transpose() / 0.02).norm(), 1e-2);
}

TEST(AlignToTemplate, WhatLiesOutsideChangesNothing) {
  const DensityMap map = TemplateOf(PatchEvents({}, 0.01, 2000, 1));
  AssociationField field;
  field.Build(map, 1.0, 0.2);
  events::LocalEvents events = PatchEvents({}, 0.01, 300, 3);
  const AlignmentOptions options{20, 15.0, 0.01, 20.0, 10.0};
  PatchMotion alone;
  alone.offset = {0.5, 0.3};
  const PatchMotion start = alone;
  AlignToTemplate(events, field, 2, options, true, &alone);
  for (int i = 0; i < 9; ++i) {
    events.x.push_back(i % 2 ? 40.0f : -1e5f);
    events.y.push_back(i % 3 ? 3.0f : -1e5f);
    events.dt.push_back(0.0f);
    events.polarity.push_back(i % 2 ? 1 : -1);
    PatchMotion motion = start;
    AlignToTemplate(events, field, 2, options, true, &motion);
    EXPECT_LT((motion.offset - alone.offset).norm(), 1e-5) << i;
    EXPECT_LT((motion.flow - alone.flow).norm(), 1e-2) << i;
  }
}

TEST(AlignToTemplate, LeavesAnAlignedWindowWhereItIs) {
  // A blurred density pulls even perfectly aligned events inwards; the template must not shrink for it.
  const events::LocalEvents events = PatchEvents({}, 0.01, 2000, 1);
  const DensityMap map = TemplateOf(events);
  AssociationField field;
  field.Build(map, 1.0, 0.2);
  PatchMotion motion;
  const auto own = field.OwnMoments(map, Matrix2d::Identity(), 15.0);
  EXPECT_LT(own(0, 1) + own(1, 2), -0.4);  // the inward pull that must not count
  AlignToTemplate(events, field, 2, {50, 15.0, 0.01, 0.0, 0.0, own}, true, &motion);
  EXPECT_LT(motion.offset.norm(), 0.03);
  // What the events' places between cells change is weighted more at the centre, where the edges here are few.
  EXPECT_NEAR(std::sqrt(motion.linear.determinant()), 1.0, 0.008);
}

TEST(AlignToTemplate, TellsForeignEventsFromItsOwn) {
  const DensityMap map = TemplateOf(PatchEvents({}, 0.01, 2000, 1));
  AssociationField field;
  field.Build(map, 1.0, 0.2);
  PatchMotion elsewhere;
  elsewhere.linear << 0.0, 1.0, -1.0, 0.0;
  const events::LocalEvents own = PatchEvents({}, 0.01, 500, 3);
  const events::LocalEvents foreign = PatchEvents(elsewhere, 0.01, 500, 4);
  PatchMotion a, b;
  const AlignmentOptions options{20, 15.0, 0.01, 20.0, 50.0, field.OwnMoments(map, Matrix2d::Identity(), 15.0)};
  EXPECT_GT(AlignToTemplate(own, field, 2, options, true, &a).inlier_share,
            1.5 * AlignToTemplate(foreign, field, 2, options, true, &b).inlier_share);
}

}  // namespace
}  // namespace evo::tracking
