#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "evo/events/event_reader.hpp"

namespace evo::events {

/// Delivers given events in blocks of `block` events.
class VectorReader : public EventReader {
 public:
  VectorReader(EventColumns events, std::size_t block) : events_(std::move(events)), block_(block) {}

  bool Next(EventColumns* block) override {
    block->clear();
    for (; next_ < events_.size() && block->size() < block_; ++next_) {
      block->push_back(events_.t[next_], events_.x[next_], events_.y[next_], events_.polarity[next_]);
    }
    return !block->empty();
  }
  TimeNs first_stamp() const override { return events_.t.front(); }
  TimeNs last_stamp() const override { return events_.t.back(); }
  double progress() const override { return static_cast<double>(next_) / static_cast<double>(events_.size()); }

 private:
  EventColumns events_;
  std::size_t block_;
  std::size_t next_ = 0;
};

/// A sensor whose events come from several causes, in any order; Sorted() brings them into that of time.
class NoiseStream {
 public:
  explicit NoiseStream(unsigned seed) : random_(seed) {}

  void Add(double t_s, int x, int y, int polarity) {
    rows_.push_back({FromSeconds(t_s), static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                     static_cast<std::int8_t>(polarity)});
  }

  /// Poisson events of random polarity at `rate` events/s.
  void AddPoisson(int x, int y, double from_s, double to_s, double rate) {
    std::exponential_distribution<double> interval(rate);
    for (double t = from_s + interval(random_); t < to_s; t += interval(random_)) Add(t, x, y, Sign());
  }

  /// Shot noise of all pixels.
  void AddShotNoise(int width, int height, double to_s, double rate) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) AddPoisson(x, y, 0.0, to_s, rate);
    }
  }

  /// A bright vertical stripe, `width_px` wide, that moves to the right over all rows and comes back in at the left.
  void AddStripe(int width, int height, double to_s, double speed_px_s, int width_px) {
    std::uniform_real_distribution<double> jitter(0.0, 0.002);
    for (int lap = 0; lap * width / speed_px_s < to_s; ++lap) {
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          const double enter = (lap * width + x) / speed_px_s;
          const double leave = enter + width_px / speed_px_s;
          for (int k = 0; k < 3; ++k) {
            if (enter < to_s) Add(enter + k * 0.2 / speed_px_s + jitter(random_), x, y, 1);
            if (leave < to_s) Add(leave + k * 0.2 / speed_px_s + jitter(random_), x, y, -1);
          }
        }
      }
    }
  }

  int Sign() { return random_() % 2 == 0 ? 1 : -1; }
  std::mt19937& random() { return random_; }

  EventColumns Sorted() const {
    auto rows = rows_;
    std::ranges::stable_sort(rows, {}, &Row::t);
    EventColumns events;
    for (const Row& row : rows) events.push_back(row.t, row.x, row.y, row.polarity);
    return events;
  }

 private:
  struct Row {
    TimeNs t;
    std::uint16_t x, y;
    std::int8_t polarity;
  };
  std::mt19937 random_;
  std::vector<Row> rows_;
};

}  // namespace evo::events
