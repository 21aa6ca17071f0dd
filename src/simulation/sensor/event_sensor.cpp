#include "simulation/sensor/event_sensor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "evo/core/error.hpp"
#include "simulation/fast_math.hpp"
#include "simulation/sensor/photoreceptor_response.hpp"

namespace evo::simulation {

namespace {

constexpr double kMinThreshold = 0.01;          // v2e's limit: a pixel below it fires at every change
constexpr double kMeanSwitchTime = 1.5;         // s between two switches of a pixel that comes and goes
constexpr std::uint64_t kHotStream = 0x686F74;  // "hot"
constexpr float kBrightNoise = 0.25F;           // shot noise rate at radiance 1 over that in the dark, as in v2e
constexpr float kMaxRadiance = 1e30F;           // FastLog still holds after dark_radiance is added
constexpr TimeNs kNotStarted = std::numeric_limits<TimeNs>::min();
constexpr TimeNs kMicrosecond = 1000;
constexpr float kRefractory = std::numeric_limits<float>::quiet_NaN();  // amplifier_ during the refractory period
constexpr float kNever = std::numeric_limits<float>::infinity();

// By value, unlike std::max and std::min: loops become vector code.
float Max(float a, float b) { return a < b ? b : a; }
float Min(float a, float b) { return b < a ? b : a; }

}  // namespace

EventSensor::EventSensor(int width, int height, const SensorOptions& options, std::uint64_t seed)
    : width_(static_cast<std::size_t>(width)),
      height_(static_cast<std::size_t>(height)),
      dark_radiance_(static_cast<float>(options.dark_radiance)),
      cut_off_per_radiance_(static_cast<float>(2.0 * std::numbers::pi * options.bandwidth_hz)),
      min_cut_off_(
          options.bandwidth_hz > 0.0
              ? std::min(static_cast<float>(2.0 * std::numbers::pi * options.dark_bandwidth_hz), cut_off_per_radiance_)
              : kNever),
      max_cut_off_(options.bandwidth_hz > 0.0 ? cut_off_per_radiance_ : kNever),
      shot_noise_hz_(static_cast<float>(options.shot_noise_hz)),
      refractory_s_(options.refractory_s),
      row_period_(FromSeconds(options.readout_row_s)) {
  constexpr int kMaxSize = std::numeric_limits<std::uint16_t>::max();
  if (width < 1 || height < 1 || width > kMaxSize || height > kMaxSize) {
    throw Error(ErrorKind::kConfiguration,
                fmt::format("an event sensor of {} x {} px is not possible; use 1 to {} on each side", width, height,
                            kMaxSize));
  }
  const std::size_t pixels = width_ * height_;
  time_.assign(pixels, kNotStarted);
  refractory_until_.assign(pixels, 0);
  for (auto* column : {&radiance_, &log_radiance_, &photoreceptor_, &amplifier_, &threshold_on_, &threshold_off_,
                       &leak_, &hot_noise_, &noise_budget_}) {
    column->assign(pixels, 0.0F);
  }
  random_.reserve(pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) InitializePixel(pixel, options, seed);
  for (std::size_t row = 0; row < height_; ++row) {
    const auto at_row = std::ranges::lower_bound(intermittent_, row * width_, {}, &IntermittentPixel::pixel);
    row_intermittent_.push_back(static_cast<std::size_t>(at_row - intermittent_.begin()));
    row_phase_.push_back(static_cast<TimeNs>(Random(seed, pixels + row).Uniform() * static_cast<double>(row_period_)));
  }
  row_intermittent_.push_back(intermittent_.size());
}

void EventSensor::InitializePixel(std::size_t pixel, const SensorOptions& options, std::uint64_t seed) {
  Random random(seed, pixel);
  const auto threshold = [&](double mean) {
    return static_cast<float>(std::max(kMinThreshold, mean + options.threshold_spread * random.Normal()));
  };
  const float on = threshold(options.threshold_on);
  const float off = threshold(options.threshold_off);
  const bool hot = random.Chance(options.hot_pixels);
  const bool dead = random.Chance(options.dead_pixels);
  const double hot_rate = options.hot_rate_hz * random.Exponential();
  const double phase = random.Uniform();
  // The leak current is the same in all pixels but the hot ones, which have a larger one.
  double leak = options.leak_hz * options.threshold_on;
  const double hot_leak = hot ? hot_rate * static_cast<double>(on) : 0.0;
  leak += hot_leak;
  threshold_on_[pixel] = dead ? kNever : on;
  threshold_off_[pixel] = dead ? kNever : off;
  leak_[pixel] = static_cast<float>(dead ? 0.0 : leak);
  // A random phase, or all leak events come at once.
  amplifier_[pixel] = leak > 0.0 && !dead ? static_cast<float>(phase) * on : 0.0F;
  noise_budget_[pixel] = dead ? kNever : static_cast<float>(random.Exponential());
  random_.push_back(random);
  if (hot && !dead && options.hot_noisy + options.hot_intermittent > 0.0) {
    InitializeHotPixel(pixel, static_cast<float>(hot_leak), options, Random(seed ^ kHotStream, pixel));
  }
}

/// Turns the leak of a hot pixel into noise, or makes it come and go, as drawn from `random`.
void EventSensor::InitializeHotPixel(std::size_t pixel, float leak, const SensorOptions& options, Random random) {
  const float usual_leak = std::max(0.0F, leak_[pixel] - leak);
  if (random.Chance(options.hot_noisy)) {
    leak_[pixel] = usual_leak;
    hot_noise_[pixel] = leak / threshold_on_[pixel];
  }
  if (!random.Chance(options.hot_intermittent)) return;
  const bool on = random.Chance(0.5);
  intermittent_.push_back({pixel, usual_leak, leak_[pixel], hot_noise_[pixel], on, kNotSwitched, random});
  if (on) return;
  leak_[pixel] = usual_leak;
  hot_noise_[pixel] = 0.0F;
}

/// Switches the pixels of `tile` that come and go on or off if it is time to at `t`.
void EventSensor::SwitchIntermittentPixels(const Tile& tile, TimeNs t) {
  for (std::size_t row = static_cast<std::size_t>(tile.y0); row < static_cast<std::size_t>(tile.y0 + tile.height);
       ++row) {
    for (std::size_t i = row_intermittent_[row]; i < row_intermittent_[row + 1]; ++i) {
      IntermittentPixel& p = intermittent_[i];
      const auto column = static_cast<int>(p.pixel % width_);
      if (column < tile.x0 || column >= tile.x0 + tile.width) continue;
      const auto draw_time = [&p] { return FromSeconds(kMeanSwitchTime * p.random.Exponential()); };
      if (p.until == kNotSwitched) p.until = t + draw_time();
      if (t < p.until) continue;
      p.on = !p.on;
      p.until += draw_time();
      leak_[p.pixel] = p.on ? p.leak : p.usual_leak;
      hot_noise_[p.pixel] = p.on ? p.noise_rate : 0.0F;
    }
  }
}

void EventSensor::CheckInput(const Tile& tile, std::span<const float> radiance) const {
  const bool inside = tile.x0 >= 0 && tile.y0 >= 0 && tile.width > 0 && tile.height > 0 &&
                      static_cast<std::size_t>(tile.x0) + static_cast<std::size_t>(tile.width) <= width_ &&
                      static_cast<std::size_t>(tile.y0) + static_cast<std::size_t>(tile.height) <= height_;
  if (!inside) throw Error(ErrorKind::kInput, "a tile lies outside the event sensor");
  if (radiance.size() != tile.pixels()) {
    throw Error(ErrorKind::kInput, fmt::format("an event sensor's tile of {} x {} px got {} values of radiance",
                                               tile.width, tile.height, radiance.size()));
  }
  std::size_t bad = 0;
  for (const float value : radiance) bad += value >= 0.0F && value <= kMaxRadiance ? 0 : 1;
  if (bad > 0) {
    throw Error(ErrorKind::kInput,
                fmt::format("negative or infinite radiance at {} of {} pixels of a tile", bad, radiance.size()));
  }
}

void EventSensor::Advance(const Tile& tile, TimeNs t, std::span<const float> radiance, events::EventColumns* events) {
  CheckInput(tile, radiance);
  const std::size_t first = static_cast<std::size_t>(tile.y0) * width_ + static_cast<std::size_t>(tile.x0);
  const TimeNs from = time_[first];
  if (from == kNotStarted) {
    InitializeTile(tile, radiance);
    time_[first] = t;
    return;
  }
  if (t <= from) throw Error(ErrorKind::kInput, "the time of an event sensor's tile does not advance");
  if (!intermittent_.empty()) SwitchIntermittentPixels(tile, from);
  const Step step{from, t, ToSeconds(t - from)};
  const auto tile_width = static_cast<std::size_t>(tile.width);
  const float* row_radiance = radiance.data();
  PixelRun run;
  for (int y = 0; y < tile.height; ++y, row_radiance += tile_width) {
    for (std::size_t x = 0; x < tile_width; x += kRunSize) {
      run.first = first + static_cast<std::size_t>(y) * width_ + x;
      run.count = std::min(kRunSize, tile_width - x);
      AdvanceRun(step, row_radiance + x, &run, events);
    }
  }
  time_[first] = t;
}

void EventSensor::InitializeTile(const Tile& tile, std::span<const float> radiance) {
  for (std::size_t k = 0; k < radiance.size(); ++k) {
    const auto tile_width = static_cast<std::size_t>(tile.width);
    const std::size_t pixel = (static_cast<std::size_t>(tile.y0) + k / tile_width) * width_ +
                              static_cast<std::size_t>(tile.x0) + k % tile_width;
    radiance_[pixel] = radiance[k];
    log_radiance_[pixel] = FastLog(radiance[k] + dark_radiance_);
    photoreceptor_[pixel] = log_radiance_[pixel];
  }
}

/// The state at the step's end of pixels without events. Returns 0 if all pixels are such.
std::int32_t EventSensor::PredictWithoutEvents(const float* radiance, float duration_s, PixelRun* run) const {
  const float* radiance_from = &radiance_[run->first];
  const float* log_from = &log_radiance_[run->first];
  const float* photoreceptor_from = &photoreceptor_[run->first];
  const float* amplifier_from = &amplifier_[run->first];
  const float* budget_from = &noise_budget_[run->first];
  const float* on = &threshold_on_[run->first];
  const float* off = &threshold_off_[run->first];
  const float* leak = &leak_[run->first];
  const float* hot_noise = &hot_noise_[run->first];
  PixelRun& __restrict to = *run;
  const std::size_t count = to.count;
  std::int32_t any = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const float input0 = log_from[k];
    const float output0 = photoreceptor_from[k];
    const float mean_radiance = 0.5F * (radiance_from[k] + radiance[k]);
    const float input1 = FastLog(radiance[k] + dark_radiance_);
    to.cut_off[k] = Min(Max(cut_off_per_radiance_ * mean_radiance, min_cut_off_), max_cut_off_);
    to.noise_rate[k] = shot_noise_hz_ * (1.0F - (1.0F - kBrightNoise) * Min(mean_radiance, 1.0F)) + hot_noise[k];
    const float time_constants = to.cut_off[k] * duration_s;
    const float response = FastOneMinusExp(time_constants);
    const float output1 =
        output0 + (input0 - output0) * response + (input1 - input0) * (1.0F - response / time_constants);
    const float leaked = amplifier_from[k] + leak[k] * duration_s;
    const float budget = budget_from[k] - to.noise_rate[k] * duration_s;
    // At an extremum within the step the output equals the input, so that it stays within the input's range.
    const bool has_extremum = (input0 - output0) * (input1 - output1) < 0.0F;
    const float max = has_extremum ? Max(input0, input1) : Max(output0, output1);
    const float min = has_extremum ? Min(input0, input1) : Min(output0, output1);
    // False for NaN: refractory.
    const bool quiet =
        (leaked + (max - output0) < on[k]) & (amplifier_from[k] + (min - output0) > -off[k]) & (budget > 0.0F);
    to.log_radiance[k] = input1;
    to.photoreceptor[k] = output1;
    to.amplifier[k] = leaked + (output1 - output0);
    to.noise_budget[k] = budget;
    to.active[k] = quiet ? 0 : 1;
    any |= to.active[k];
  }
  return any;
}

void EventSensor::AdvanceRun(const Step& step, const float* radiance, PixelRun* run, events::EventColumns* events) {
  if (PredictWithoutEvents(radiance, static_cast<float>(step.duration_s), run) != 0) {
    for (std::size_t k = 0; k < run->count; ++k) {
      if (run->active[k] != 0) FindEvents(step, k, run, events);
    }
  }
  std::copy_n(radiance, run->count, &radiance_[run->first]);
  std::copy_n(run->log_radiance, run->count, &log_radiance_[run->first]);
  std::copy_n(run->photoreceptor, run->count, &photoreceptor_[run->first]);
  std::copy_n(run->amplifier, run->count, &amplifier_[run->first]);
  std::copy_n(run->noise_budget, run->count, &noise_budget_[run->first]);
}

/// Finds the events of pixel k of the run, one after the other.
void EventSensor::FindEvents(const Step& step, std::size_t k, PixelRun* run, events::EventColumns* events) {
  const std::size_t pixel = run->first + k;
  const double slope = static_cast<double>(run->log_radiance[k] - log_radiance_[pixel]) / step.duration_s;
  const PhotoreceptorResponse signal(log_radiance_[pixel], slope, photoreceptor_[pixel], run->cut_off[k], leak_[pixel]);
  double now = 0.0;  // s since the step's start
  double amplifier = amplifier_[pixel];
  double budget = noise_budget_[pixel];
  const double noise_rate = run->noise_rate[k];
  bool refractory = std::isnan(amplifier_[pixel]);
  if (refractory) now = std::max(0.0, ToSeconds(refractory_until_[pixel] - step.from));
  while (true) {
    if (refractory && now >= step.duration_s) break;
    if (refractory) amplifier = 0.0;
    refractory = false;
    const double reset_level = signal.Evaluate(now) - amplifier;
    const double noise_at = noise_rate > 0.0 ? now + budget / noise_rate : kNever;
    const double end = std::min(noise_at, step.duration_s);
    const auto crossing =
        signal.FirstCrossing(now, end, reset_level - threshold_off_[pixel], reset_level + threshold_on_[pixel]);
    const double event_at = crossing ? crossing->t : end;
    budget -= noise_rate * (event_at - now);
    if (!crossing && noise_at > step.duration_s) {
      amplifier = signal.Evaluate(step.duration_s) - reset_level;
      break;
    }
    const int polarity = crossing ? crossing->polarity : random_[pixel].Chance(0.5) ? 1 : -1;
    if (!crossing) budget = random_[pixel].Exponential();
    const TimeNs event_time = step.from + FromSeconds(event_at);
    EmitEvent(pixel, event_time, polarity, events);
    refractory_until_[pixel] = event_time + FromSeconds(refractory_s_);
    refractory = true;
    now = event_at + refractory_s_;
  }
  run->amplifier[k] = refractory ? kRefractory : static_cast<float>(amplifier);
  run->noise_budget[k] = static_cast<float>(budget);
}

void EventSensor::EmitEvent(std::size_t pixel, TimeNs t, int polarity, events::EventColumns* events) const {
  const std::size_t row = pixel / width_;
  if (row_period_ > 0) {
    const TimeNs since_readout = (t - row_phase_[row]) % row_period_;
    if (since_readout != 0) t += (since_readout < 0 ? 0 : row_period_) - since_readout;
  }
  t -= (t % kMicrosecond + kMicrosecond) % kMicrosecond;  // rounds down, also before 0
  events->push_back(t, static_cast<std::uint16_t>(pixel % width_), static_cast<std::uint16_t>(row),
                    static_cast<std::int8_t>(polarity));
}

}  // namespace evo::simulation
