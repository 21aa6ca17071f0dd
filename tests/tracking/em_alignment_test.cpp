#include "tracking/patch/em_alignment.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "tracking/patch_events.hpp"

namespace evo::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using testing::PatchEvents;

EventHistogram TemplateOf(const events::LocalEvents& events) {
  EventHistogram histogram(19, 2);
  for (std::size_t i = 0; i < events.size(); ++i) {
    histogram.Vote(events.x[i], events.y[i], histogram.PlaneOf(events.polarity[i]), 1.0f);
  }
  return histogram;
}

/// Events at random places of the template.
events::LocalEvents NoiseEvents(int count, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<float>(static_cast<double>(random()) / 4294967296.0); };
  events::LocalEvents events;
  for (int i = 0; i < count; ++i) {
    const float x = 38.0f * uniform() - 19.0f;
    const float y = 38.0f * uniform() - 19.0f;
    events.push_back(x, y, 0.0f, i % 2 ? 1 : -1);
  }
  return events;
}

TEST(AlignToTemplate, RecoversAKnownAffineMotion) {
  const EventHistogram histogram = TemplateOf(PatchEvents({}, 0.01, 2000, 1));
  AssociationTable coarse, fine;
  coarse.Build(histogram, 2.5, 0.2);
  fine.Build(histogram, 1.0, 0.2);
  PatchMotion truth;
  truth.offset = {1.7, -1.1};
  truth.flow = {90, -40};
  truth.linear << 1.06, 0.02, -0.03, 1.04;
  const events::LocalEvents events = PatchEvents(truth, 0.02, 600, 2);

  PatchMotion motion;
  motion.flow = {80, -30};
  AlignmentOptions options{20, 15.0, 0.02, 5.0, 5.0, coarse.ComputeSelfBias(histogram, Matrix2d::Identity(), 15.0)};
  AlignToTemplate(events, coarse, 2, options, false, &motion);
  options.iterations = 50;
  options.self_bias = fine.ComputeSelfBias(histogram, Matrix2d::Identity(), 15.0);
  const AlignmentQuality quality = AlignToTemplate(events, fine, 2, options, true, &motion);
  EXPECT_GT(quality.inlier_ratio, 0.7);
  EXPECT_LT(quality.residual_px, 1.0);
  EXPECT_LT((motion.offset - truth.offset).norm(), 0.15);
  EXPECT_LT((motion.flow - truth.flow).norm(), 12.0);
  EXPECT_LT((motion.linear - truth.linear).norm(), 0.04);
}

TEST(MeanLogLikelihoodRatio, TellsAPatternFromNoise) {
  AssociationTable table;
  table.Build(TemplateOf(PatchEvents({}, 0.01, 300, 1)), 1.0, 0.2);
  EXPECT_GT(MeanLogLikelihoodRatio(PatchEvents({}, 0.01, 300, 2), table, 2, {}), 0.8);
  EXPECT_LT(MeanLogLikelihoodRatio(NoiseEvents(300, 2), table, 2, {}), 0.0) << "noise under a pattern";
  table.Build(TemplateOf(NoiseEvents(300, 1)), 1.0, 0.2);
  EXPECT_LT(MeanLogLikelihoodRatio(NoiseEvents(300, 2), table, 2, {}), 0.0) << "noise under other noise";
  EXPECT_EQ(MeanLogLikelihoodRatio({}, table, 2, {}), 0.0);
}

TEST(MeanLogLikelihoodRatio, IsTheMeanOfTheLogarithmsOverTheEvents) {
  const events::LocalEvents events = PatchEvents({}, 0.01, 37, 2);  // not a multiple of eight
  const EventHistogram histogram = TemplateOf(PatchEvents({}, 0.01, 300, 1));
  AssociationTable table;
  table.Build(histogram, 1.0, 0.2);
  double sum = 0.0, weight = 0.0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const int plane = histogram.PlaneOf(events.polarity[i]);
    const Eigen::Array4d at = table.Interpolate(events.x[i], events.y[i], plane).cast<double>();
    if (!(at[3] > 0.0)) continue;
    sum -= at[3] * (std::log(1.0 - at[0] / at[3]) + static_cast<double>(table.log_even_density(plane)));
    weight += at[3];
  }
  EXPECT_NEAR(MeanLogLikelihoodRatio(events, table, 2, {}), sum / weight, 1e-3);
}

TEST(TemplatePoints, InvertTheMotion) {
  PatchMotion motion;
  motion.offset = {1.2, -0.7};
  motion.flow = {90, -40};
  motion.linear << 1.2, 0.1, -0.05, 1.1;
  motion.perspective = {0.01, -0.015};
  motion.linear_rate << 2.0, 0.3, -0.2, 1.5;
  motion.quadratic_rate = {0.02, 0.03};
  events::LocalEvents events;
  std::vector<Vector2d> truth;
  const double dt = 0.01;
  for (int x = -8; x <= 8; x += 4) {
    for (int y = -8; y <= 8; y += 4) {
      const Vector2d u(x, y);
      const Vector2d at_reference = motion.linear * u / (1.0 + motion.perspective.dot(u));
      const Vector2d moving =
          motion.linear_rate * at_reference + motion.quadratic_rate.dot(at_reference) * at_reference;
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

TEST(ApplyCorrection, MovesTemplatePointsByTheCorrection) {
  // The rows (1, dt / half window, u / radius, v / radius) of the M step are the Jacobian of the template points.
  constexpr double kHalfWindow = 0.02;
  constexpr double kRadius = 8.0;
  constexpr double kDifference = 0.01;
  PatchMotion motion;
  motion.offset = {1.2, -0.7};
  motion.flow = {90, -40};
  motion.linear << 1.2, 0.1, -0.05, 1.1;
  events::LocalEvents events = PatchEvents(motion, kHalfWindow, 20, 1);
  TemplatePoints points, after, before;
  points.Update(events, motion);
  for (int row = 0; row < 4; ++row) {
    for (int axis = 0; axis < 2; ++axis) {
      TemplateCorrection correction = TemplateCorrection::Zero();
      correction(row, axis) = kDifference;
      PatchMotion plus = motion, minus = motion;
      ApplyCorrection(correction, kHalfWindow, kRadius, &plus);
      ApplyCorrection(-correction, kHalfWindow, kRadius, &minus);
      after.Update(events, plus);
      before.Update(events, minus);
      for (std::size_t i = 0; i < events.size(); ++i) {
        const Eigen::Vector4d jacobian(1.0, events.dt[i] / kHalfWindow, points.u[i] / kRadius, points.v[i] / kRadius);
        const Vector2d numeric = Vector2d(after.u[i] - before.u[i], after.v[i] - before.v[i]) / (2.0 * kDifference);
        EXPECT_NEAR(numeric[axis], jacobian[row], 1e-3) << row << ", " << axis;
        EXPECT_NEAR(numeric[1 - axis], 0.0, 1e-3) << row << ", " << axis;
      }
    }
  }
}

TEST(AlignToTemplate, OneStepIsTheLeastSquaresOfTheShifts) {
  const EventHistogram histogram = TemplateOf(PatchEvents({}, 0.01, 2000, 1));
  AssociationTable table;
  table.Build(histogram, 1.0, 0.2);
  PatchMotion truth;
  truth.offset = {0.7, -0.4};
  truth.flow = {40, -30};
  const events::LocalEvents events = PatchEvents(truth, 0.02, 611, 2);
  PatchMotion motion;
  motion.flow = {35, -25};
  motion.perspective = {0.004, -0.002};
  motion.linear_rate << 1.0, 0.1, -0.2, 0.8;
  TemplatePoints points;
  points.Update(events, motion);
  Eigen::Matrix4d normal = Eigen::Vector4d(0.0, 20.0, 10.0, 10.0).asDiagonal();
  Eigen::Matrix<double, 4, 2> right = Eigen::Matrix<double, 4, 2>::Zero();
  double all = 0.0, inliers = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Eigen::Vector4d row(1.0, events.dt[i] / 0.02, points.u[i] / 15.0, points.v[i] / 15.0);
    const Eigen::Array4d association =
        table.Interpolate(points.u[i], points.v[i], events.polarity[i] < 0 ? 1 : 0).cast<double>();
    normal += association[0] * row * row.transpose();
    right += row * Eigen::RowVector2d(association[1], association[2]);
    inliers += association[0];
    all += association[3];
    if (association[0] > 0.0)
      squares += (association[1] * association[1] + association[2] * association[2]) / association[0];
  }
  const Eigen::Matrix<double, 4, 2> step = 1.5 * normal.inverse() * right;
  const AlignmentQuality quality = AlignToTemplate(events, table, 2, {1, 15.0, 0.02, 20.0, 10.0}, true, &motion);
  EXPECT_NEAR(quality.inlier_ratio, inliers / all, 1e-4);
  EXPECT_NEAR(quality.residual_px, std::sqrt(squares / inliers), 1e-4);
  Matrix2d linear;
  linear << step(2, 0), step(3, 0), step(2, 1), step(3, 1);
  linear = (Matrix2d::Identity() + linear / 15.0).inverse().eval();
  EXPECT_GT(step.row(0).norm(), 0.1);
  EXPECT_LT((motion.linear - linear).norm(), 1e-4);
  EXPECT_LT((motion.offset + linear * step.row(0).transpose()).norm(), 1e-4);
  EXPECT_LT((motion.flow - Vector2d(35, -25) + linear * step.row(1).transpose() / 0.02).norm(), 1e-2);
}

TEST(AlignToTemplate, EventsOutsideChangeNothing) {
  const EventHistogram histogram = TemplateOf(PatchEvents({}, 0.01, 2000, 1));
  AssociationTable table;
  table.Build(histogram, 1.0, 0.2);
  events::LocalEvents events = PatchEvents({}, 0.01, 300, 3);
  const AlignmentOptions options{20, 15.0, 0.01, 20.0, 10.0};
  PatchMotion alone;
  alone.offset = {0.5, 0.3};
  const PatchMotion start = alone;
  AlignToTemplate(events, table, 2, options, true, &alone);
  for (int i = 0; i < 9; ++i) {
    events.x.push_back(i % 2 ? 40.0f : -1e5f);
    events.y.push_back(i % 3 ? 3.0f : -1e5f);
    events.dt.push_back(0.0f);
    events.polarity.push_back(i % 2 ? 1 : -1);
    PatchMotion motion = start;
    AlignToTemplate(events, table, 2, options, true, &motion);
    EXPECT_LT((motion.offset - alone.offset).norm(), 1e-5) << i;
    EXPECT_LT((motion.flow - alone.flow).norm(), 1e-2) << i;
  }
}

TEST(AlignToTemplate, LeavesAnAlignedWindowWhereItIs) {
  // A blurred density shifts even perfectly aligned events inwards; the template must not shrink.
  const events::LocalEvents events = PatchEvents({}, 0.01, 2000, 1);
  const EventHistogram histogram = TemplateOf(events);
  AssociationTable table;
  table.Build(histogram, 1.0, 0.2);
  PatchMotion motion;
  const SelfBias bias = table.ComputeSelfBias(histogram, Matrix2d::Identity(), 15.0);
  EXPECT_LT(bias(0, 1) + bias(1, 2), -0.4);  // inwards
  AlignToTemplate(events, table, 2, {50, 15.0, 0.01, 0.0, 0.0, bias}, true, &motion);
  EXPECT_LT(motion.offset.norm(), 0.03);
  // Votes between cells add noise, and the weights favour the centre, where this template has few edges.
  EXPECT_NEAR(std::sqrt(motion.linear.determinant()), 1.0, 0.008);
}

TEST(AlignToTemplate, TellsForeignEventsFromItsOwn) {
  const EventHistogram histogram = TemplateOf(PatchEvents({}, 0.01, 2000, 1));
  AssociationTable table;
  table.Build(histogram, 1.0, 0.2);
  PatchMotion elsewhere;
  elsewhere.linear << 0.0, 1.0, -1.0, 0.0;
  const events::LocalEvents own = PatchEvents({}, 0.01, 500, 3);
  const events::LocalEvents foreign = PatchEvents(elsewhere, 0.01, 500, 4);
  PatchMotion a, b;
  const AlignmentOptions options{20,   15.0, 0.01,
                                 20.0, 50.0, table.ComputeSelfBias(histogram, Matrix2d::Identity(), 15.0)};
  EXPECT_GT(AlignToTemplate(own, table, 2, options, true, &a).inlier_ratio,
            1.5 * AlignToTemplate(foreign, table, 2, options, true, &b).inlier_ratio);
}

}  // namespace
}  // namespace evo::tracking
