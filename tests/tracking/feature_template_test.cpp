#include "tracking/feature_template.hpp"

#include <gtest/gtest.h>

namespace evo::tracking {
namespace {

constexpr TimeNs kHalfWindow = 10'000'000;

/// A window of events at one place, px.
events::LocalEvents EventsAt(float x, float y, std::size_t count) {
  events::LocalEvents events;
  events.x.assign(count, x);
  events.y.assign(count, y);
  events.dt.assign(count, 0.0f);
  events.polarity.assign(count, 1);
  return events;
}

FeatureTemplate MakeTemplate() {
  EventHistogram first(12, 1);
  Accumulate(EventsAt(-3.0f, 0.0f, 40), {}, &first);
  return FeatureTemplate(first, {});
}

float CellAt(const FeatureTemplate& model, int x, int y) {
  const EventHistogram& histogram = model.histogram();
  return histogram.plane(0)[(y + histogram.radius()) * histogram.side() + x + histogram.radius()];
}

void Learn(FeatureTemplate* model, double elapsed_s, PatchShape* shape) {
  TrackerOptions options;
  options.template_gain = 0.5;
  model->AddTime(elapsed_s);
  PatchMotion motion;
  motion.linear = shape->linear;
  model->Learn({EventsAt(2.0f, 0.0f, 100), motion, kHalfWindow, PolarityFlips()}, options, shape);
}

TEST(FeatureTemplate, WeighsWindowsEquallyHoweverManyEventsTheyHold) {
  FeatureTemplate model = MakeTemplate();
  EXPECT_FLOAT_EQ(CellAt(model, -3, 0), 1.0f);
  PatchShape shape;
  Learn(&model, 1.0, &shape);
  EXPECT_FLOAT_EQ(CellAt(model, -3, 0), 0.5f);
  EXPECT_FLOAT_EQ(CellAt(model, 2, 0), 0.5f);
}

TEST(FeatureTemplate, IgnoresAWindowThatRepeatsTheLastOne) {
  FeatureTemplate model = MakeTemplate();
  model.set_self_bias(SelfBias::Ones());
  PatchShape shape;
  Learn(&model, 0.3 * 2.0 * ToSeconds(kHalfWindow), &shape);
  EXPECT_FLOAT_EQ(CellAt(model, -3, 0), 1.0f);
  EXPECT_TRUE(model.self_bias().has_value());
  Learn(&model, 0.3 * 2.0 * ToSeconds(kHalfWindow), &shape);  // together they are new enough
  EXPECT_LT(CellAt(model, -3, 0), 1.0f);
  EXPECT_FALSE(model.self_bias().has_value()) << "it is that of another histogram";
}

TEST(FeatureTemplate, ResamplesWhenThePatchHasGrown) {
  FeatureTemplate model = MakeTemplate();
  PatchShape shape{1.2 * Eigen::Matrix2d::Identity()};
  Learn(&model, 1.0, &shape);
  EXPECT_DOUBLE_EQ(model.scale(), 1.0);
  shape.linear = 2.0 * Eigen::Matrix2d::Identity();
  Learn(&model, 1.0, &shape);
  EXPECT_NEAR(model.scale(), 2.0, 1e-12);
  EXPECT_TRUE(shape.linear.isIdentity());
  EXPECT_GT(CellAt(model, -6, 0), CellAt(model, -3, 0)) << "the first window's events moved outwards";
}

}  // namespace
}  // namespace evo::tracking
