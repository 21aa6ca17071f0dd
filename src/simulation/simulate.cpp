#include "evo/simulation/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/core/progress.hpp"
#include "evo/simulation/true_maps.hpp"
#include "simulation/render/renderer.hpp"
#include "simulation/sensor/auto_exposure.hpp"
#include "simulation/sensor/event_merger.hpp"
#include "simulation/sensor/event_sensor.hpp"

namespace evo::simulation {

namespace {

constexpr TimeNs kMicrosecond = 1000;
constexpr TimeNs kBatch = 10'000'000;      // 10 ms: visible sets and image speeds are found once per batch
constexpr int kMaxRendersPerBatch = 1000;  // of a tile: 10 us, far below any sensor's time constant
constexpr double kStepsPerFlicker = 8.0;   // of the sensor per period of lamps of depth 0.5: its low-pass sees a sine

/// Times k / rate in whole microseconds, from 0.
class Schedule {
 public:
  explicit Schedule(double hz) : hz_(hz) {}

  /// Calls `take` for each time before `end` that was not taken yet.
  template <typename Take>
  void TakeBefore(TimeNs end, const Take& take) {
    for (; hz_ > 0.0 && NextTime() < end; ++next_) take(NextTime());
  }

 private:
  TimeNs NextTime() const { return std::llround(1e6 * static_cast<double>(next_) / hz_) * kMicrosecond; }

  double hz_;
  std::size_t next_ = 0;
};

class Simulation {
 public:
  Simulation(const SimulatedRun& run, const SceneOptions& options, ThreadPool* pool, SimulationSink* sink)
      : run_(run),
        options_(options.simulation),
        renderer_(*run.scene, run.camera, options_.samples),
        depth_camera_(*run.scene, run.camera, pool),
        sensor_(run.camera.width(), run.camera.height(), options.sensor, static_cast<std::uint64_t>(options.seed)),
        pool_(pool),
        sink_(sink),
        image_times_(options_.image_hz),
        depth_times_(options_.depth_hz) {
    for (const Tile& tile : CutIntoTiles(run.camera.width(), run.camera.height(), options_.tile_px)) {
      tiles_.push_back({.tile = tile});
    }
  }

  SimulationCounts Run(Progress* progress) {
    const TimeNs start = -std::min(FromSeconds(options_.lead_in_s), run_.before);
    RenderStart(start);
    for (TimeNs begin = start; begin < 0; begin += kBatch) RenderBatch(begin, std::min(begin + kBatch, TimeNs{0}));
    for (TimeNs begin = 0; begin < run_.duration; begin += kBatch) {
      const TimeNs end = std::min(begin + kBatch, run_.duration);
      RenderBatch(begin, end);
      const events::EventColumns& batch = DeliverEvents(end);
      image_times_.TakeBefore(end, [&](TimeNs t) { DeliverImage(t, batch); });
      depth_times_.TakeBefore(end, [&](TimeNs t) { DeliverDepth(t); });
      if (progress) progress->Update(ToSeconds(end) / ToSeconds(run_.duration));
    }
    for (const TileState& state : tiles_) counts_.pixel_renders += state.renders * state.tile.pixels();
    return counts_;
  }

 private:
  struct TileState {
    Tile tile;
    Renderer::Radiance radiance{};  ///< of the last render
    events::EventColumns events{};  ///< not merged yet
    std::size_t renders = 0;
  };

  /// Sets the state of the pixels at `t`.
  void RenderStart(TimeNs t) {
    const geometry::SE3 T_world_cam = run_.T_world_cam(t);
    pool_->ForEach(tiles_.size(), [&](std::size_t i) {
      TileState& state = tiles_[i];
      const auto visible = renderer_.FindVisible(state.tile, t, t, T_world_cam, T_world_cam);
      renderer_.Render(state.tile, visible, t, T_world_cam, &state.radiance);
      sensor_.Advance(state.tile, t, RadianceAt(t, state.radiance), &state.events);
    });
  }

  void RenderBatch(TimeNs begin, TimeNs end) {
    const geometry::SE3 T_world_begin = run_.T_world_cam(begin);
    const geometry::SE3 T_world_end = run_.T_world_cam(end);
    pool_->ForEach(tiles_.size(), [&](std::size_t i) {
      TileState& state = tiles_[i];
      const auto visible = renderer_.FindVisible(state.tile, begin, end, T_world_begin, T_world_end);
      const double speed = renderer_.ImageSpeed(state.tile, visible, begin, end, T_world_begin, T_world_end);
      const double duration_s = ToSeconds(end - begin);
      const double needed = std::max(speed * duration_s / options_.max_step_px, duration_s / options_.max_step_s);
      const auto renders = static_cast<TimeNs>(std::ceil(std::min<double>(needed, kMaxRendersPerBatch)));
      Renderer::Radiance radiance;
      TimeNs previous = begin;
      for (TimeNs k = 1; k <= renders; ++k) {
        const TimeNs t = begin + (end - begin) * k / renders;
        renderer_.Render(state.tile, visible, t, run_.T_world_cam(t), &radiance);
        AdvanceSensor(previous, t, radiance, &state);
        std::swap(state.radiance, radiance);
        previous = t;
      }
      state.renders += static_cast<std::size_t>(renders);
    });
  }

  /// Advances the sensor's tile from its last render to `next`, in smaller steps under flickering lamps. Both parts of
  /// the radiance are linear in time.
  void AdvanceSensor(TimeNs from, TimeNs to, const Renderer::Radiance& next, TileState* state) {
    const Renderer::Radiance& last = state->radiance;
    if (!last.has_lamps && !next.has_lamps) return sensor_.Advance(state->tile, to, next.steady, &state->events);
    const Lighting& lighting = run_.scene->lighting;
    // The width of the minimum of log radiance is proportional to sqrt(1 - depth).
    const double steps_per_flicker = kStepsPerFlicker * std::sqrt(0.5 / (1.0 - std::max(lighting.flicker_depth, 0.5)));
    const double needed = ToSeconds(to - from) * lighting.flicker_hz * steps_per_flicker;
    const auto steps = std::max<TimeNs>(1, static_cast<TimeNs>(std::ceil(needed)));
    std::vector<float> radiance(next.steady.size());
    for (TimeNs k = 1; k <= steps; ++k) {
      const TimeNs t = from + (to - from) * k / steps;
      const auto weight = static_cast<float>(k) / static_cast<float>(steps);
      const auto flicker = static_cast<float>(Flicker(lighting, t));
      for (std::size_t p = 0; p < radiance.size(); ++p) {
        const float at_last = last.steady[p] + flicker * last.lamps[p];
        const float at_next = next.steady[p] + flicker * next.lamps[p];
        radiance[p] = (1.0F - weight) * at_last + weight * at_next;
      }
      sensor_.Advance(state->tile, t, radiance, &state->events);
    }
  }

  /// The sum of both parts at `t`.
  std::vector<float> RadianceAt(TimeNs t, const Renderer::Radiance& radiance) const {
    const auto flicker = static_cast<float>(Flicker(run_.scene->lighting, t));
    std::vector<float> sum = radiance.steady;
    for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += flicker * radiance.lamps[p];
    return sum;
  }

  /// Delivers the events before `end`. Events at `end` or, delayed by the readout, after it wait for those of the
  /// following batches.
  const events::EventColumns& DeliverEvents(TimeNs end) {
    for (TileState& state : tiles_) {
      merger_.Add(state.events);
      state.events.clear();
    }
    const events::EventColumns& batch = merger_.TakeBefore(end);
    counts_.events += batch.size();
    counts_.positive += static_cast<std::size_t>(
        std::ranges::count_if(batch.polarity, [](const auto polarity) { return polarity > 0; }));
    sink_->OnEvents(batch);
    return batch;
  }

  /// `batch` holds the events that were delivered last.
  void DeliverImage(TimeNs t, const events::EventColumns& batch) {
    const auto after = batch.t.end() - std::ranges::lower_bound(batch.t, t);
    ++counts_.images;
    sink_->OnImage(t, exposure_.Expose(run_.camera.width(), run_.camera.height(), RenderFrame(t)),
                   counts_.events - static_cast<std::size_t>(after));
  }

  void DeliverDepth(TimeNs t) {
    ++counts_.depth_maps;
    sink_->OnDepth(t, depth_camera_.Render(t, run_.T_world_cam(t)));
  }

  /// Radiance of all pixels at `t`, row by row.
  std::vector<float> RenderFrame(TimeNs t) const {
    const int width = run_.camera.width();
    std::vector<float> frame(Tile{0, 0, width, run_.camera.height()}.pixels());
    const geometry::SE3 T_world_cam = run_.T_world_cam(t);
    pool_->ForEach(tiles_.size(), [&](std::size_t i) {
      const Tile& tile = tiles_[i].tile;
      const auto visible = renderer_.FindVisible(tile, t, t, T_world_cam, T_world_cam);
      Renderer::Radiance radiance;
      renderer_.Render(tile, visible, t, T_world_cam, &radiance);
      const std::vector<float> values = RadianceAt(t, radiance);
      for (int row = 0; row < tile.height; ++row) {
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row) * tile.width, tile.width,
                    frame.begin() + static_cast<std::ptrdiff_t>(tile.y0 + row) * width + tile.x0);
      }
    });
    return frame;
  }

  const SimulatedRun& run_;
  const SimulationOptions& options_;
  Renderer renderer_;
  DepthCamera depth_camera_;
  EventSensor sensor_;
  ThreadPool* pool_;
  SimulationSink* sink_;
  std::vector<TileState> tiles_;
  EventMerger merger_;
  AutoExposure exposure_;
  Schedule image_times_;
  Schedule depth_times_;
  SimulationCounts counts_;
};

}  // namespace

SimulationCounts Simulate(const SimulatedRun& run, const SceneOptions& options, ThreadPool* pool, SimulationSink* sink,
                          Progress* progress) {
  return Simulation(run, options, pool, sink).Run(progress);
}

}  // namespace evo::simulation
