#include "evo/simulation/event_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "evo/core/error.hpp"
#include "simulation/render/fast_math.hpp"
#include "simulation/sensor/step_signal.hpp"

namespace evo::simulation {

namespace {

constexpr double kLowestThreshold = 0.01;
constexpr float kBrightNoise = 0.25F;      // noise of a bright pixel relative to that of a dark one
constexpr float kHighestRadiance = 1e30F;  // where FastLog still holds after dark_radiance is added
constexpr TimeNs kNotStarted = std::numeric_limits<TimeNs>::min();
constexpr TimeNs kMicrosecond = 1000;
constexpr float kBlind = std::numeric_limits<float>::quiet_NaN();
constexpr float kNever = std::numeric_limits<float>::infinity();

// By value, unlike std::max, so that loops are vectorised.
float Higher(float a, float b) { return a < b ? b : a; }
float Lower(float a, float b) { return b < a ? b : a; }

}  // namespace

void Register(Parameters& parameters, SensorOptions& o) {
  parameters.Add("sensor.threshold_on", &o.threshold_on, 0.01, 10.0,
                 "change of log intensity that makes a positive event, mean over the pixels");
  parameters.Add("sensor.threshold_off", &o.threshold_off, 0.01, 10.0, "and a negative one");
  parameters.Add("sensor.threshold_spread", &o.threshold_spread, 0.0, 1.0,
                 "standard deviation of both thresholds over the pixels");
  parameters.Add("sensor.bandwidth_hz", &o.bandwidth_hz, 0.0, 1e6,
                 "cut-off of the photoreceptor's low-pass from radiance 1 on; 0: no low-pass");
  parameters.Add("sensor.dark_bandwidth_hz", &o.dark_bandwidth_hz, 0.01, 1e6,
                 "its cut-off in the dark; between the two it is proportional to radiance");
  parameters.Add("sensor.refractory_s", &o.refractory_s, 0.0, 1.0, "s that a pixel is blind after an event");
  parameters.Add("sensor.leak_hz", &o.leak_hz, 0.0, 1000.0, "positive events of a pixel that sees no change");
  parameters.Add("sensor.shot_noise_hz", &o.shot_noise_hz, 0.0, 1000.0,
                 "random events of a dark pixel; one of radiance 1 has a quarter");
  parameters.Add("sensor.hot_pixels", &o.hot_pixels, 0.0, 1.0, "share of pixels that fire by themselves");
  parameters.Add("sensor.hot_rate_hz", &o.hot_rate_hz, 0.0, 1e5, "mean rate of such a pixel");
  parameters.Add("sensor.dead_pixels", &o.dead_pixels, 0.0, 1.0, "share of pixels that never fire");
  parameters.Add("sensor.dark_radiance", &o.dark_radiance, 1e-6, 10.0, "added to all radiance: the dark current");
  parameters.Add("sensor.readout_row_s", &o.readout_row_s, 0.0, 0.1,
                 "s between two readouts of a row, which stamp its events; 0: stamped at once");
}

EventSensor::EventSensor(int width, int height, const SensorOptions& options, std::uint64_t seed)
    : width_(static_cast<std::size_t>(width)),
      height_(static_cast<std::size_t>(height)),
      dark_radiance_(static_cast<float>(options.dark_radiance)),
      cut_off_slope_(static_cast<float>(2.0 * std::numbers::pi * options.bandwidth_hz)),
      cut_off_low_(
          options.bandwidth_hz > 0.0
              ? std::min(static_cast<float>(2.0 * std::numbers::pi * options.dark_bandwidth_hz), cut_off_slope_)
              : kNever),
      cut_off_high_(options.bandwidth_hz > 0.0 ? cut_off_slope_ : kNever),
      shot_noise_hz_(static_cast<float>(options.shot_noise_hz)),
      refractory_s_(options.refractory_s),
      row_period_(FromSeconds(options.readout_row_s)) {
  constexpr int kMaxSize = std::numeric_limits<std::uint16_t>::max();
  if (width < 1 || height < 1 || width > kMaxSize || height > kMaxSize) {
    throw Error(ErrorKind::kConfiguration,
                "an event sensor of " + std::to_string(width) + " x " + std::to_string(height) + " pixels cannot be");
  }
  const std::size_t pixels = width_ * height_;
  time_.assign(pixels, kNotStarted);
  blind_until_.assign(pixels, 0);
  for (auto* column : {&radiance_, &log_, &filtered_, &change_, &threshold_on_, &threshold_off_, &leak_, &budget_}) {
    column->assign(pixels, 0.0F);
  }
  random_.reserve(pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) DrawPixel(pixel, options, Random(seed, pixel));
  for (std::size_t row = 0; row < height_; ++row) {
    row_phase_.push_back(static_cast<TimeNs>(Random(seed, pixels + row).Uniform() * static_cast<double>(row_period_)));
  }
}

void EventSensor::DrawPixel(std::size_t pixel, const SensorOptions& options, Random random) {
  const auto threshold = [&](double mean) {
    return static_cast<float>(std::max(kLowestThreshold, mean + options.threshold_spread * random.Normal()));
  };
  const float on = threshold(options.threshold_on);
  const float off = threshold(options.threshold_off);
  const bool hot = random.Chance(options.hot_pixels);
  const bool dead = random.Chance(options.dead_pixels);
  const double hot_rate = options.hot_rate_hz * random.Exponential();
  const double phase = random.Uniform();
  // The leak is a current of the same size in every pixel; hot ones have a faster one.
  double leak = options.leak_hz * options.threshold_on;
  if (hot) leak += hot_rate * static_cast<double>(on);
  threshold_on_[pixel] = dead ? kNever : on;
  threshold_off_[pixel] = dead ? kNever : off;
  leak_[pixel] = static_cast<float>(dead ? 0.0 : leak);
  change_[pixel] = leak > 0.0 && !dead ? static_cast<float>(phase) * on : 0.0F;  // else all leak events come at once
  budget_[pixel] = dead ? kNever : static_cast<float>(random.Exponential());
  random_.push_back(random);
}

void EventSensor::Check(const Tile& tile, std::span<const float> radiance) const {
  const bool inside = tile.x0 >= 0 && tile.y0 >= 0 && tile.width > 0 && tile.height > 0 &&
                      static_cast<std::size_t>(tile.x0) + static_cast<std::size_t>(tile.width) <= width_ &&
                      static_cast<std::size_t>(tile.y0) + static_cast<std::size_t>(tile.height) <= height_;
  if (!inside) throw Error(ErrorKind::kInput, "a tile lies outside the event sensor");
  if (radiance.size() != static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height)) {
    throw Error(ErrorKind::kInput, "an event sensor's tile of " + std::to_string(tile.width) + " x " +
                                       std::to_string(tile.height) + " pixels got " + std::to_string(radiance.size()) +
                                       " values of radiance");
  }
  std::size_t bad = 0;
  for (const float value : radiance) bad += value >= 0.0F && value <= kHighestRadiance ? 0 : 1;
  if (bad > 0) {
    throw Error(ErrorKind::kInput, "negative or infinite radiance at " + std::to_string(bad) + " of " +
                                       std::to_string(radiance.size()) + " pixels of a tile");
  }
}

void EventSensor::Advance(const Tile& tile, TimeNs t, std::span<const float> radiance, events::EventColumns* events) {
  Check(tile, radiance);
  const std::size_t first = static_cast<std::size_t>(tile.y0) * width_ + static_cast<std::size_t>(tile.x0);
  const TimeNs from = time_[first];
  if (from == kNotStarted) {
    Start(tile, radiance);
    time_[first] = t;
    return;
  }
  if (t <= from) throw Error(ErrorKind::kInput, "the time of an event sensor's tile does not advance");
  const Step step{from, t, ToSeconds(t - from)};
  const auto tile_width = static_cast<std::size_t>(tile.width);
  const float* row_radiance = radiance.data();
  Run run;
  for (int y = 0; y < tile.height; ++y, row_radiance += tile_width) {
    for (std::size_t x = 0; x < tile_width; x += kRun) {
      run.first = first + static_cast<std::size_t>(y) * width_ + x;
      run.count = std::min(kRun, tile_width - x);
      AdvanceRun(step, row_radiance + x, &run, events);
    }
  }
  time_[first] = t;
}

void EventSensor::Start(const Tile& tile, std::span<const float> radiance) {
  for (std::size_t k = 0; k < radiance.size(); ++k) {
    const auto tile_width = static_cast<std::size_t>(tile.width);
    const std::size_t pixel = (static_cast<std::size_t>(tile.y0) + k / tile_width) * width_ +
                              static_cast<std::size_t>(tile.x0) + k % tile_width;
    radiance_[pixel] = radiance[k];
    log_[pixel] = FastLog(radiance[k] + dark_radiance_);
    filtered_[pixel] = log_[pixel];
  }
}

// The whole step for pixels in which nothing happens; the result says whether there are others.
std::int32_t EventSensor::Predict(const float* radiance, float duration_s, Run* run) const {
  const float* radiance_from = &radiance_[run->first];
  const float* log_from = &log_[run->first];
  const float* filtered_from = &filtered_[run->first];
  const float* change_from = &change_[run->first];
  const float* budget_from = &budget_[run->first];
  const float* on = &threshold_on_[run->first];
  const float* off = &threshold_off_[run->first];
  const float* leak = &leak_[run->first];
  Run& __restrict to = *run;
  const std::size_t count = to.count;
  std::int32_t any = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const float log0 = log_from[k];
    const float filtered0 = filtered_from[k];
    const float mean_radiance = 0.5F * (radiance_from[k] + radiance[k]);
    const float log1 = FastLog(radiance[k] + dark_radiance_);
    to.cut_off[k] = Lower(Higher(cut_off_slope_ * mean_radiance, cut_off_low_), cut_off_high_);
    to.noise_rate[k] = shot_noise_hz_ * (1.0F - (1.0F - kBrightNoise) * Lower(mean_radiance, 1.0F));
    const float constants = to.cut_off[k] * duration_s;
    const float share = FastOneMinusExp(constants);
    const float filtered1 = filtered0 + (log0 - filtered0) * share + (log1 - log0) * (1.0F - share / constants);
    const float leaked = change_from[k] + leak[k] * duration_s;
    const float budget = budget_from[k] - to.noise_rate[k] * duration_s;
    // Where the signal turns within the step it meets its input, so it stays within the input's range.
    const bool turns = (log0 - filtered0) * (log1 - filtered1) < 0.0F;
    const float highest = turns ? Higher(log0, log1) : Higher(filtered0, filtered1);
    const float lowest = turns ? Lower(log0, log1) : Lower(filtered0, filtered1);
    // Not fulfilled if NaN: blind.
    const bool quiet =
        (leaked + (highest - filtered0) < on[k]) & (change_from[k] + (lowest - filtered0) > -off[k]) & (budget > 0.0F);
    to.log[k] = log1;
    to.filtered[k] = filtered1;
    to.change[k] = leaked + (filtered1 - filtered0);
    to.budget[k] = budget;
    to.busy[k] = quiet ? 0 : 1;
    any |= to.busy[k];
  }
  return any;
}

void EventSensor::AdvanceRun(const Step& step, const float* radiance, Run* run, events::EventColumns* events) {
  if (Predict(radiance, static_cast<float>(step.duration_s), run) != 0) {
    for (std::size_t k = 0; k < run->count; ++k) {
      if (run->busy[k] != 0) Resolve(step, k, run, events);
    }
  }
  std::copy_n(radiance, run->count, &radiance_[run->first]);
  std::copy_n(run->log, run->count, &log_[run->first]);
  std::copy_n(run->filtered, run->count, &filtered_[run->first]);
  std::copy_n(run->change, run->count, &change_[run->first]);
  std::copy_n(run->budget, run->count, &budget_[run->first]);
}

// Event after event of pixel k of the run.
void EventSensor::Resolve(const Step& step, std::size_t k, Run* run, events::EventColumns* events) {
  const std::size_t pixel = run->first + k;
  const double slope = static_cast<double>(run->log[k] - log_[pixel]) / step.duration_s;
  const StepSignal signal(log_[pixel], slope, filtered_[pixel], run->cut_off[k], leak_[pixel]);
  double now = 0.0;  // s since the step's start
  double change = change_[pixel];
  double budget = budget_[pixel];
  const double noise_rate = run->noise_rate[k];
  bool blind = std::isnan(change_[pixel]);
  if (blind) now = std::max(0.0, ToSeconds(blind_until_[pixel] - step.from));
  while (true) {
    if (blind && now >= step.duration_s) break;
    if (blind) change = 0.0;
    blind = false;
    const double zero = signal.At(now) - change;
    const double noise_at = noise_rate > 0.0 ? now + budget / noise_rate : kNever;
    const double end = std::min(noise_at, step.duration_s);
    const auto crossing = signal.FirstCrossing(now, end, zero - threshold_off_[pixel], zero + threshold_on_[pixel]);
    const double event_at = crossing ? crossing->t : end;
    budget -= noise_rate * (event_at - now);
    if (!crossing && noise_at > step.duration_s) {
      change = signal.At(step.duration_s) - zero;
      break;
    }
    const int sign = crossing ? crossing->sign : random_[pixel].Chance(0.5) ? 1 : -1;
    if (!crossing) budget = random_[pixel].Exponential();
    const TimeNs event_time = step.from + FromSeconds(event_at);
    Emit(pixel, event_time, sign, events);
    blind_until_[pixel] = event_time + FromSeconds(refractory_s_);
    blind = true;
    now = event_at + refractory_s_;
  }
  run->change[k] = blind ? kBlind : static_cast<float>(change);
  run->budget[k] = static_cast<float>(budget);
}

void EventSensor::Emit(std::size_t pixel, TimeNs t, int sign, events::EventColumns* events) const {
  const std::size_t row = pixel / width_;
  if (row_period_ > 0) {
    const TimeNs since = (t - row_phase_[row]) % row_period_;
    if (since != 0) t += (since < 0 ? 0 : row_period_) - since;
  }
  t -= (t % kMicrosecond + kMicrosecond) % kMicrosecond;  // down, before 0 too
  events->push_back(t, static_cast<std::uint16_t>(pixel % width_), static_cast<std::uint16_t>(row),
                    static_cast<std::int8_t>(sign));
}

}  // namespace evo::simulation
