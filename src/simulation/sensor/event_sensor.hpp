#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "evo/core/random.hpp"
#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"
#include "evo/simulation/scene_options.hpp"
#include "simulation/render/tile.hpp"

namespace evo::simulation {

// The pixel of P. Lichtsteiner et al. (A 128 x 128 120 dB 15 us Latency Asynchronous Temporal Contrast Vision Sensor,
// JSSC 2008): a logarithmic photoreceptor, a differencing amplifier and two comparators. Noise and its dependence on
// light follow Y. Hu et al. (v2e, CVPRW 2021), leak events Y. Nozaki and T. Delbruck (Temperature and Parasitic
// Photocurrent Effects in Dynamic Vision Sensors, TED 2017), crossing times H. Rebecq et al. (ESIM, CoRL 2018).
//
//   photoreceptor   L = log(radiance + dark_radiance),  dy/dt = 2 pi f (L - y),
//                   f = bandwidth_hz * radiance, within [dark_bandwidth_hz, bandwidth_hz]
//   amplifier       v = y(t) - y(t_reset) + leak * (t - t_reset)
//   hot pixels      leak more, or fire at random with both polarities, some for a while only
//   comparators     +1 event at v = threshold_on, -1 event at v = -threshold_off; shot noise events come at random
//   times
//                   with random polarity. The pixel is reset at the end of the refractory period that follows an event:
//                   t_reset = t + refractory_s.
//
// For each pixel, threshold_on times its positive events minus threshold_off times its negative events is the change of
// y, but for changes during refractory periods. A scene that returns to its start thus gives threshold_on /
// threshold_off negative events for each positive one.

/// The state of all pixels. Each pixel has a random stream of its own, so that the result does not depend on the order
/// of the tiles. Threads may advance different tiles at the same time.
class EventSensor {
 public:
  /// Error (kConfiguration) for a size that is not positive or does not fit the columns of events.
  EventSensor(int width, int height, const SensorOptions& options, std::uint64_t seed);

  /// Advances the pixels of `tile` to time `t`, when they see `radiance` (row by row, >= 0); log radiance is linear in
  /// time between two calls. Appends the events since the last call to `events`: pixels row by row, each pixel's events
  /// in order of time. Stamps are whole microseconds, rounded down, at most readout_row_s later than `t`. The first
  /// call sets the state only. All calls must use the tiles of one partition of the sensor. Error (kInput) for radiance
  /// that is negative or not finite, a tile outside the sensor or a time that does not advance.
  void Advance(const Tile& tile, TimeNs t, std::span<const float> radiance, events::EventColumns* events);

 private:
  static constexpr std::size_t kRunSize = 64;  // fits into the first-level cache
  /// Neighbouring pixels of a row at the end of a step.
  struct PixelRun {
    std::size_t first = 0;  ///< pixel
    std::size_t count = 0;
    float log_radiance[kRunSize];
    float photoreceptor[kRunSize];
    float amplifier[kRunSize];
    float noise_budget[kRunSize];
    float cut_off[kRunSize];        ///< rad/s, during the step
    float noise_rate[kRunSize];     ///< 1/s, during the step
    std::int32_t active[kRunSize];  ///< not 0: the pixel may have events
  };
  struct Step {
    TimeNs from = 0;
    TimeNs to = 0;
    double duration_s = 0.0;
  };

  /// A hot pixel that comes and goes: a random telegraph signal.
  struct IntermittentPixel {
    std::size_t pixel = 0;
    float usual_leak = 0.0F;  ///< while it is off, 1/s
    float leak = 0.0F;        ///< while it is on, 1/s
    float noise_rate = 0.0F;  ///< likewise, 1/s
    bool on = false;
    TimeNs until = kNotSwitched;  ///< of the present state
    Random random{0};
  };
  static constexpr TimeNs kNotSwitched = std::numeric_limits<TimeNs>::min();

  void InitializePixel(std::size_t pixel, const SensorOptions& options, std::uint64_t seed);
  void InitializeHotPixel(std::size_t pixel, float leak, const SensorOptions& options, Random random);
  void SwitchIntermittentPixels(const Tile& tile, TimeNs t);
  void CheckInput(const Tile& tile, std::span<const float> radiance) const;
  void InitializeTile(const Tile& tile, std::span<const float> radiance);
  std::int32_t PredictWithoutEvents(const float* radiance, float duration_s, PixelRun* run) const;
  void AdvanceRun(const Step& step, const float* radiance, PixelRun* run, events::EventColumns* events);
  void FindEvents(const Step& step, std::size_t k, PixelRun* run, events::EventColumns* events);
  void EmitEvent(std::size_t pixel, TimeNs t, int polarity, events::EventColumns* events) const;

  std::size_t width_;
  std::size_t height_;
  float dark_radiance_;
  float cut_off_per_radiance_;  ///< rad/s
  float min_cut_off_;           ///< rad/s; infinite: no low-pass
  float max_cut_off_;           ///< rad/s
  float shot_noise_hz_;
  double refractory_s_;
  TimeNs row_period_;
  std::vector<TimeNs> row_phase_;  ///< per row

  // Per pixel, row by row.
  std::vector<TimeNs> time_;  ///< of the last call, kept at the first pixel of each tile
  std::vector<float> radiance_;
  std::vector<float> log_radiance_;   ///< L
  std::vector<float> photoreceptor_;  ///< y
  std::vector<float> amplifier_;      ///< v; NaN: refractory
  std::vector<TimeNs> refractory_until_;
  std::vector<float> threshold_on_;
  std::vector<float> threshold_off_;
  std::vector<float> leak_;          ///< 1/s
  std::vector<float> hot_noise_;     ///< rate of the noise of hot pixels, 1/s
  std::vector<float> noise_budget_;  ///< integral of the noise rate up to the next shot noise event
  std::vector<Random> random_;

  std::vector<IntermittentPixel> intermittent_;  ///< by pixel
  std::vector<std::size_t> row_intermittent_;    ///< per row: the first of the row or a later one; and the end
};

}  // namespace evo::simulation
