#include "evo/tracking/event_density.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "evo/tracking/density_map.hpp"

namespace evo {
namespace {

struct Event {
  float x, y;
  int plane;
};

std::vector<Event> Events() {
  std::vector<Event> events;
  for (int i = 0; i < 150; ++i) {
    const auto s = static_cast<float>(i);
    events.push_back({6.0f * std::sin(0.7f * s), 0.05f * s - 4.0f, i % 2});
  }
  return events;
}

TEST(EventDensity, PullsAsTheTableOfAssociationsDoes) {
  constexpr int kRadius = 17;
  constexpr double kSigma = 1.5;
  constexpr double kStray = 0.2;
  EventDensity density(kRadius, 2, kSigma);
  DensityMap map(kRadius, 2);
  density.Clear();
  for (const Event& event : Events()) {
    density.Vote(event.x, event.y, event.plane);
    map.Vote(event.x, event.y, event.plane, 1.0f);
  }
  density.Smooth(kStray);
  AssociationField field;
  field.Build(map, kSigma, kStray);
  for (const Event& event : Events()) {
    // Between cells the two interpolate different things.
    const EventDensity::Pull pull = density.At(event.x, event.y, event.plane);
    const AssociationField::Pull weighted = field.At(event.x, event.y, event.plane);
    if (weighted[3] < 0.1f) continue;
    const AssociationField::Pull expected = weighted / weighted[3];
    EXPECT_NEAR(pull.weight, expected[0], 0.03);
    EXPECT_NEAR(pull.x, expected[1], 0.15);
    EXPECT_NEAR(pull.y, expected[2], 0.15);
    const float x = std::round(event.x);
    const float y = std::round(event.y);
    const AssociationField::Pull cell = field.At(x, y, 0);
    EXPECT_NEAR(cell[3] * density.At(x, y, 0).x, cell[1], 1e-4);
  }
}

TEST(EventDensity, LeavesOutWhatLiesOutside) {
  EventDensity density(5, 1, 3.0);
  density.Clear();
  for (const float far : {-6.0f, 5.0f, 1e9f, std::nanf("")}) {
    density.Vote(far, 0.0f, 0);
    density.Vote(0.0f, far, 0);
  }
  density.Smooth(0.2);
  EXPECT_EQ(density.At(0.0f, 0.0f, 0).weight, 0.0f);
  EXPECT_EQ(density.At(5.0f, 0.0f, 0).weight, 0.0f);
}

}  // namespace
}  // namespace evo
