#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "evo/events/event_columns.hpp"
#include "evo/events/event_reader.hpp"
#include "evo/geometry/camera.hpp"

namespace evo::tracking::testing {

/// Shift of the scene at time t (s), px.
using Motion = std::function<Eigen::Vector2d(double)>;

/// Small crosses at random places that move together. Every point of a cross fires at a steady rate at its pixel,
/// without a lag; the two arms have opposite polarities at first. Like an edge's, the polarity of an arm changes when
/// the motion crosses the arm the other way.
struct CrossScene {
  int width = 120;
  int height = 90;
  std::vector<Eigen::Vector2d> centres;

  CrossScene(int count, unsigned seed) {
    std::mt19937 random(seed);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
    while (static_cast<int>(centres.size()) < count) {
      const Eigen::Vector2d c(-60.0 + 240.0 * uniform(), -60.0 + 210.0 * uniform());
      if (std::ranges::all_of(centres, [&](const auto& o) { return (o - c).norm() > 14.0; })) centres.push_back(c);
    }
  }

  static constexpr double kStepS = 1e-4;  // of the difference that tells the velocity

  events::EventColumns Events(const Motion& motion, double duration_s, double rate_hz = 500.0,
                              unsigned seed = 3) const {
    std::mt19937 random(seed);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
    struct Event {
      TimeNs t;
      int x, y;
      int sign;
    };
    std::vector<Event> events;
    for (const auto& centre : centres) {
      for (int arm = -4; arm <= 4; ++arm) {
        for (const bool upright : {false, true}) {
          const Eigen::Vector2d point = centre + (upright ? Eigen::Vector2d(0, arm) : Eigen::Vector2d(arm, 0));
          for (double t = uniform() / rate_hz; t < duration_s; t += (0.5 + uniform()) / rate_hz) {
            const Eigen::Vector2d p = point + motion(t);
            const int x = static_cast<int>(std::lround(p.x()));
            const int y = static_cast<int>(std::lround(p.y()));
            if (x < 0 || y < 0 || x >= width || y >= height) continue;
            const Eigen::Vector2d step = motion(t + kStepS) - motion(t - kStepS);
            const Eigen::Vector2d first = motion(kStepS) - motion(0.0);
            const bool is_as_first = (upright ? step.x() * first.x() : step.y() * first.y()) >= 0.0;
            events.push_back({FromSeconds(t), x, y, upright == is_as_first ? 1 : -1});
          }
        }
      }
    }
    std::ranges::stable_sort(events, {}, &Event::t);
    events::EventColumns columns;
    for (const Event& e : events) {
      columns.push_back(e.t, static_cast<std::uint16_t>(e.x), static_cast<std::uint16_t>(e.y),
                        static_cast<std::int8_t>(e.sign));
    }
    return columns;
  }
};

/// A camera of the scene's size. Its lens is so long that rotations shift the image as a whole.
inline geometry::Camera SceneCamera() {
  geometry::Calibration calibration;
  calibration.width = 120;
  calibration.height = 90;
  calibration.fx = calibration.fy = 1000.0;
  calibration.cx = 60.0;
  calibration.cy = 45.0;
  return geometry::Camera(calibration);
}

/// Reads events from memory, in blocks.
class MemoryReader : public events::EventReader {
 public:
  explicit MemoryReader(events::EventColumns events, std::size_t block = 1000)
      : events_(std::move(events)), block_(block) {}

  bool Next(events::EventColumns* block) override {
    block->clear();
    for (std::size_t i = 0; i < block_ && next_ < events_.size(); ++i, ++next_) {
      block->push_back(events_.t[next_], events_.x[next_], events_.y[next_], events_.polarity[next_]);
    }
    return !block->empty();
  }
  TimeNs first_stamp() const override { return events_.empty() ? 0 : events_.t.front(); }
  TimeNs last_stamp() const override { return events_.empty() ? 0 : events_.t.back(); }
  double progress() const override { return static_cast<double>(next_) / static_cast<double>(events_.size()); }

 private:
  events::EventColumns events_;
  std::size_t block_;
  std::size_t next_ = 0;
};

}  // namespace evo::tracking::testing
