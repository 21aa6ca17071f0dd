#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/core/random.hpp"
#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"
#include "evo/simulation/renderer.hpp"

namespace evo::simulation {

// The pixel of P. Lichtsteiner et al. (A 128 x 128 120 dB 15 us latency asynchronous temporal contrast vision sensor,
// JSSC 2008): a logarithmic photoreceptor, a differencing amplifier, two comparators. Its noise and its dependence on
// light follow Y. Hu et al. (v2e, CVPRW 2021), the leak Y. Nozaki and T. Delbruck (Temperature and parasitic
// photocurrent effects in dynamic vision sensors, TED 2017), the crossing times H. Rebecq et al. (ESIM, CoRL 2018).
//
//   photoreceptor   L = log(radiance + dark_radiance),  dy/dt = 2 pi f (L - y),
//                   f = bandwidth_hz * radiance, within [dark_bandwidth_hz, bandwidth_hz]
//   change          v = y(t) - y(t_reset) + leak * (t - t_reset)
//   event           +1 where v reaches the pixel's threshold_on, -1 where it reaches -threshold_off; so does a noise
//                   event at random times and of random sign. The pixel is then blind for refractory_s and starts
//                   again from what it sees at the end of that: t_reset = t + refractory_s.
//
// So for every pixel, but for what changes while it is blind, the sum of thresholds over its positive events less that
// over its negative ones is the change of y: in a scene that comes back to where it was there are
// threshold_on / threshold_off negative events for each positive one.

/// The defaults are a DAVIS346 as set up for the MVSEC drives: about three negative events for each positive one. They
/// hold for day and night: it is the light that makes the pixels slow and noisy.
struct SensorOptions {
  double threshold_on = 0.65;       ///< change of log intensity that makes a positive event
  double threshold_off = 0.18;      ///< and a negative one; lower: more negative events
  double threshold_spread = 0.03;   ///< standard deviation of both over the pixels; none falls below 0.01
  double bandwidth_hz = 300.0;      ///< cut-off of the photoreceptor from radiance 1 on; 0: none, y = L
  double dark_bandwidth_hz = 10.0;  ///< cut-off in the dark; between the two it is proportional to radiance
  double refractory_s = 0.0005;     ///< a pixel is blind so long after an event
  double leak_hz = 0.1;             ///< positive events of a pixel with mean thresholds that sees no change
  double shot_noise_hz = 0.5;       ///< random events of a dark pixel; a bright one (radiance 1) has a quarter
  double hot_pixels = 0.0002;       ///< share of pixels that leak so fast that they fire by themselves
  double hot_rate_hz = 100.0;       ///< mean rate of such a pixel
  double dead_pixels = 0.0002;      ///< share of pixels that never fire
  double dark_radiance = 0.002;     ///< added to all radiance: the dark current
  double readout_row_s = 0.0;       ///< a row is read out once in so long, its events are stamped then; 0: at once
};

void Register(Parameters& parameters, SensorOptions& options);

/// The state of all pixels. Each has its own random stream, so that tiles can be advanced in any order and in parallel
/// (one thread a tile) with the same result.
class EventSensor {
 public:
  /// Error (kConfiguration) for a size that is not positive or does not fit the columns of events.
  EventSensor(int width, int height, const SensorOptions& options, std::uint64_t seed);

  /// Tells the pixels of `tile` the radiance that they see at `t` (row by row, >= 0); between two calls for one tile it
  /// is taken to change linearly in its logarithm. Appends the events since the last call to `events`, each pixel's in
  /// order of time, the pixels row by row, stamps in whole microseconds (rounded down), at most readout_row_s later
  /// than `t`. The first call only sets the state. The tiles must be those of one cut of the sensor, the same at every
  /// call. Error (kInput) for radiance that is not finite, a tile outside the sensor or a time that does not advance.
  void Advance(const Tile& tile, TimeNs t, std::span<const float> radiance, events::EventColumns* events);

 private:
  static constexpr std::size_t kRun = 64;
  /// Neighbouring pixels of a row at the end of a step.
  struct Run {
    std::size_t first = 0;  ///< pixel
    std::size_t count = 0;
    float log[kRun];
    float filtered[kRun];
    float change[kRun];
    float budget[kRun];
    float cut_off[kRun];      ///< rad/s, during the step
    float noise_rate[kRun];   ///< 1/s, during the step
    std::int32_t busy[kRun];  ///< not 0: something may have happened
  };
  struct Step {
    TimeNs from = 0;
    TimeNs to = 0;
    double duration_s = 0.0;
  };

  void DrawPixel(std::size_t pixel, const SensorOptions& options, Random random);
  void Check(const Tile& tile, std::span<const float> radiance) const;
  void Start(const Tile& tile, std::span<const float> radiance);
  std::int32_t Predict(const float* radiance, float duration_s, Run* run) const;
  void AdvanceRun(const Step& step, const float* radiance, Run* run, events::EventColumns* events);
  void Resolve(const Step& step, std::size_t k, Run* run, events::EventColumns* events);
  void Emit(std::size_t pixel, TimeNs t, int sign, events::EventColumns* events) const;

  std::size_t width_;
  std::size_t height_;
  float dark_radiance_;
  float cut_off_slope_;  ///< rad/s per radiance
  float cut_off_low_;    ///< rad/s; infinite: no low-pass
  float cut_off_high_;
  float shot_noise_hz_;
  double refractory_s_;
  TimeNs row_period_;
  std::vector<TimeNs> row_phase_;  ///< per row

  // Per pixel, row by row.
  std::vector<TimeNs> time_;  ///< of the last call, kept at the first pixel of each tile
  std::vector<float> radiance_;
  std::vector<float> log_;       ///< L
  std::vector<float> filtered_;  ///< y
  std::vector<float> change_;    ///< v; NaN: blind
  std::vector<TimeNs> blind_until_;
  std::vector<float> threshold_on_;
  std::vector<float> threshold_off_;
  std::vector<float> leak_;    ///< 1/s
  std::vector<float> budget_;  ///< noise events that may still be expected before the next one comes
  std::vector<Random> random_;
};

}  // namespace evo::simulation
