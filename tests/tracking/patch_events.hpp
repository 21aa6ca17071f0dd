#pragma once

#include <Eigen/Core>
#include <random>

#include "evo/events/event_history.hpp"
#include "tracking/patch/em_alignment.hpp"

namespace evo::tracking::testing {

/// Events of edges near the centre of a patch with a known affine motion; half a window on either side of the reference
/// instant, with pixel noise.
inline events::LocalEvents PatchEvents(const PatchMotion& motion, double half_window_s, int count, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  const Eigen::Vector2d corners[] = {{-9, -7}, {8, -9}, {10, 6}, {-6, 9}, {0, 1}, {3, -2}};
  events::LocalEvents events;
  for (int i = 0; i < count; ++i) {
    const int edge = static_cast<int>(uniform() * 5.0);
    const Eigen::Vector2d u = corners[edge] + uniform() * (corners[edge + 1] - corners[edge]);
    const double dt = half_window_s * (2.0 * uniform() - 1.0);
    const Eigen::Vector2d x = motion.offset + motion.flow * dt + motion.linear * u;
    events.x.push_back(static_cast<float>(x.x() + 0.6 * (uniform() - 0.5)));
    events.y.push_back(static_cast<float>(x.y() + 0.6 * (uniform() - 0.5)));
    events.dt.push_back(static_cast<float>(dt));
    events.polarity.push_back(edge % 2 ? 1 : -1);
  }
  return events;
}

}  // namespace evo::tracking::testing
