#include "evo/simulation/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "evo/simulation/renderer.hpp"
#include "evo/simulation/true_maps.hpp"
#include "simulation/sensor/exposure.hpp"

namespace evo::simulation {

namespace {

constexpr TimeNs kMicrosecond = 1000;
constexpr TimeNs kSlab = 10'000'000;      // tiles look up their surfaces and speed once a slab
constexpr int kMostRenders = 1000;        // of a tile in a slab: 10 us, well below any sensor's bandwidth
constexpr double kStepsPerFlicker = 8.0;  // of the sensor in a period of the lamps

/// Times k / rate in whole microseconds, from 0.
class Schedule {
 public:
  explicit Schedule(double hz) : hz_(hz) {}

  /// Calls `take` for each time before `end` that was not taken yet.
  template <typename Take>
  void TakeUntil(TimeNs end, const Take& take) {
    for (; hz_ > 0.0 && Time() < end; ++next_) take(Time());
  }

 private:
  TimeNs Time() const { return std::llround(1e6 * static_cast<double>(next_) / hz_) * kMicrosecond; }

  double hz_;
  std::size_t next_ = 0;
};

class Simulation {
 public:
  Simulation(const Scene& scene, const geometry::Camera& camera, const CameraMotion& motion,
             const SensorOptions& sensor, const SimulationOptions& options, std::uint64_t seed, ThreadPool* pool,
             SimulationSink* sink)
      : scene_(scene),
        camera_(camera),
        motion_(motion),
        options_(options),
        renderer_(scene, camera, options.samples),
        depth_camera_(scene, camera, pool),
        sensor_(camera.width(), camera.height(), sensor, seed),
        pool_(pool),
        sink_(sink),
        tiles_(CutIntoTiles(camera.width(), camera.height(), options.tile_px)),
        tile_radiance_(tiles_.size()),
        tile_events_(tiles_.size()),
        tile_renders_(tiles_.size()),
        images_(options.image_hz),
        depth_maps_(options.depth_hz) {}

  SimulationCounts Run(TimeNs lead_in, TimeNs duration, Progress* progress) {
    RenderStart(-lead_in);
    for (TimeNs begin = -lead_in; begin < 0; begin += kSlab) RenderSlab(begin, std::min(begin + kSlab, TimeNs{0}));
    for (TimeNs begin = 0; begin < duration; begin += kSlab) {
      const TimeNs end = std::min(begin + kSlab, duration);
      RenderSlab(begin, end);
      DeliverEvents(end);
      images_.TakeUntil(end, [&](TimeNs t) { DeliverImage(t); });
      depth_maps_.TakeUntil(end, [&](TimeNs t) { DeliverDepth(t); });
      if (progress) progress->Update(ToSeconds(end) / ToSeconds(duration));
    }
    counts_.pixel_renders = std::accumulate(tile_renders_.begin(), tile_renders_.end(), std::size_t{0});
    return counts_;
  }

 private:
  static std::size_t PixelsOf(const Tile& tile) {
    return static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
  }

  /// The state of the pixels at `t`.
  void RenderStart(TimeNs t) {
    const geometry::SE3 T_world_cam = motion_(t);
    pool_->ForEach(tiles_.size(), [&](std::size_t i) {
      const auto visible = renderer_.FindVisible(tiles_[i], t, t, T_world_cam, T_world_cam);
      renderer_.Render(tiles_[i], visible, t, T_world_cam, &tile_radiance_[i]);
      sensor_.Advance(tiles_[i], t, At(t, tile_radiance_[i]), &tile_events_[i]);
    });
  }

  void RenderSlab(TimeNs begin, TimeNs end) {
    const geometry::SE3 T_world_begin = motion_(begin);
    const geometry::SE3 T_world_end = motion_(end);
    pool_->ForEach(tiles_.size(), [&](std::size_t i) {
      const Tile& tile = tiles_[i];
      const auto visible = renderer_.FindVisible(tile, begin, end, T_world_begin, T_world_end);
      const double speed = renderer_.ImageSpeed(tile, visible, begin, end, T_world_begin, T_world_end);
      const double duration_s = ToSeconds(end - begin);
      const double needed =
          std::max(speed * duration_s / options_.largest_step_px, duration_s / options_.longest_step_s);
      const auto renders = static_cast<TimeNs>(std::ceil(std::min<double>(needed, kMostRenders)));
      Renderer::Radiance radiance;
      TimeNs before = begin;
      for (TimeNs k = 1; k <= renders; ++k) {
        const TimeNs t = begin + (end - begin) * k / renders;
        renderer_.Render(tile, visible, t, motion_(t), &radiance);
        AdvanceTile(i, before, t, radiance);
        std::swap(tile_radiance_[i], radiance);
        before = t;
      }
      tile_renders_[i] += static_cast<std::size_t>(renders) * PixelsOf(tile);
    });
  }

  /// Advances the sensor's tile i from its last render to `next`. Where lamps flicker that takes steps of their own,
  /// between which both parts of the radiance change linearly.
  void AdvanceTile(std::size_t i, TimeNs from, TimeNs to, const Renderer::Radiance& next) {
    const Renderer::Radiance& last = tile_radiance_[i];
    if (!last.lit && !next.lit) return sensor_.Advance(tiles_[i], to, next.steady, &tile_events_[i]);
    const double needed = ToSeconds(to - from) * scene_.lighting.flicker_hz * kStepsPerFlicker;
    const auto steps = std::max<TimeNs>(1, static_cast<TimeNs>(std::ceil(needed)));
    std::vector<float> seen(next.steady.size());
    for (TimeNs k = 1; k <= steps; ++k) {
      const TimeNs t = from + (to - from) * k / steps;
      const auto share = static_cast<float>(k) / static_cast<float>(steps);
      const auto flicker = static_cast<float>(Flicker(scene_.lighting, t));
      for (std::size_t p = 0; p < seen.size(); ++p) {
        const float at_last = last.steady[p] + flicker * last.lamps[p];
        const float at_next = next.steady[p] + flicker * next.lamps[p];
        seen[p] = (1.0F - share) * at_last + share * at_next;
      }
      sensor_.Advance(tiles_[i], t, seen, &tile_events_[i]);
    }
  }

  /// The whole radiance at `t`.
  std::vector<float> At(TimeNs t, const Renderer::Radiance& radiance) const {
    const auto flicker = static_cast<float>(Flicker(scene_.lighting, t));
    std::vector<float> sum = radiance.steady;
    for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += flicker * radiance.lamps[p];
    return sum;
  }

  /// Hands on the events before `end`; later tiles and slabs may still add to those at `end` or, delayed by the
  /// readout, after it.
  void DeliverEvents(TimeNs end) {
    for (auto& events : tile_events_) {
      for (std::size_t i = 0; i < events.size(); ++i) {
        if (events.t[i] < 0) continue;  // of the lead-in
        waiting_.push_back({events.t[i], events.y[i], events.x[i], events.polarity[i]});
      }
      events.clear();
    }
    std::ranges::sort(waiting_);
    const auto later = std::ranges::lower_bound(waiting_, end, {}, &Event::t);
    batch_.clear();
    for (auto event = waiting_.begin(); event != later; ++event) {
      batch_.push_back(event->t, event->x, event->y, event->polarity);
      if (event->polarity > 0) ++counts_.positive;
    }
    waiting_.erase(waiting_.begin(), later);
    counts_.events += batch_.size();
    sink_->OnEvents(batch_);
  }

  void DeliverImage(TimeNs t) {
    RenderFrame(t);
    const auto after = batch_.t.end() - std::ranges::lower_bound(batch_.t, t);
    ++counts_.images;
    sink_->OnImage(t, exposure_.Expose(camera_.width(), camera_.height(), frame_),
                   counts_.events - static_cast<std::size_t>(after));
  }

  void DeliverDepth(TimeNs t) {
    ++counts_.depth_maps;
    sink_->OnDepth(t, depth_camera_.At(t, motion_(t)));
  }

  /// All tiles at `t` into `frame_`.
  void RenderFrame(TimeNs t) {
    frame_.resize(PixelsOf({0, 0, camera_.width(), camera_.height()}));
    const geometry::SE3 T_world_cam = motion_(t);
    pool_->ForEach(tiles_.size(), [&](std::size_t i) {
      const Tile& tile = tiles_[i];
      const auto visible = renderer_.FindVisible(tile, t, t, T_world_cam, T_world_cam);
      Renderer::Radiance radiance;
      renderer_.Render(tile, visible, t, T_world_cam, &radiance);
      const std::vector<float> values = At(t, radiance);
      for (int row = 0; row < tile.height; ++row) {
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row) * tile.width, tile.width,
                    frame_.begin() + static_cast<std::ptrdiff_t>(tile.y0 + row) * camera_.width() + tile.x0);
      }
    });
  }

  /// In the order in which events are delivered.
  struct Event {
    TimeNs t;
    std::uint16_t y;
    std::uint16_t x;
    std::int8_t polarity;
    auto operator<=>(const Event&) const = default;
  };

  const Scene& scene_;
  const geometry::Camera& camera_;
  const CameraMotion& motion_;
  const SimulationOptions& options_;
  Renderer renderer_;
  DepthCamera depth_camera_;
  EventSensor sensor_;
  ThreadPool* pool_;
  SimulationSink* sink_;
  std::vector<Tile> tiles_;
  std::vector<Renderer::Radiance> tile_radiance_;  ///< of the last render
  std::vector<events::EventColumns> tile_events_;
  std::vector<std::size_t> tile_renders_;
  std::vector<Event> waiting_;  ///< not delivered yet
  events::EventColumns batch_;  ///< delivered last
  std::vector<float> frame_;
  Schedule images_;
  Schedule depth_maps_;
  Exposure exposure_;
  SimulationCounts counts_;
};

}  // namespace

void Register(Parameters& p, SimulationOptions& o) {
  p.Add("simulation.samples", &o.samples, 1, 8, "rays a pixel, along each side");
  p.Add("simulation.largest_step_px", &o.largest_step_px, 0.05, 10.0, "motion between two renders (px)");
  p.Add("simulation.longest_step_s", &o.longest_step_s, 1e-4, 0.01, "between two renders where nothing moves (s)");
  p.Add("simulation.tile_px", &o.tile_px, 4, 256, "side of the tiles that have render rates of their own (px)");
  p.Add("simulation.lead_in_s", &o.lead_in_s, 0.0, 10.0,
        "the camera sees the scene so long before the sequence begins, if that is not at the scene's start (s)");
  p.Add("simulation.image_hz", &o.image_hz, 0.0, 1000.0, "grey images a second; 0: none");
  p.Add("simulation.depth_hz", &o.depth_hz, 0.0, 1000.0, "depth maps a second, about 0.2 MB each; 0: none");
}

SimulationCounts Simulate(const Scene& scene, const geometry::Camera& camera, const CameraMotion& motion,
                          TimeNs lead_in, TimeNs duration, const SensorOptions& sensor,
                          const SimulationOptions& options, std::uint64_t seed, ThreadPool* pool, Progress* progress,
                          SimulationSink* sink) {
  return Simulation(scene, camera, motion, sensor, options, seed, pool, sink).Run(lead_in, duration, progress);
}

}  // namespace evo::simulation
