#include "simulation/step_signal.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "evo/simulation/fast_math.hpp"

namespace evo {

namespace {

constexpr double kPrecision = 1e-8;  // s
constexpr int kMaxIterations = 60;

}  // namespace

StepSignal::StepSignal(double input, double slope, double output, double cut_off, double leak)
    : slope_(slope + leak), turn_(std::numeric_limits<double>::infinity()) {
  const bool follows = std::isinf(cut_off);
  cut_off_ = follows ? 0.0 : cut_off;
  start_ = follows ? input : input - slope / cut_off;
  transient_ = follows ? 0.0 : output - start_;
  const double decay = slope_ / (cut_off_ * transient_);  // where the slope is 0
  if (decay > 0.0 && decay < 1.0) turn_ = -std::log(decay) / cut_off_;
}

double StepSignal::Decay(double t) const {
  return transient_ * static_cast<double>(FastExpOfMinus(static_cast<float>(cut_off_ * t)));
}

double StepSignal::At(double t) const { return start_ + slope_ * t + Decay(t); }

double StepSignal::Slope(double t) const { return slope_ - cut_off_ * Decay(t); }

std::optional<StepSignal::Crossing> StepSignal::FirstCrossing(double from, double to, double low, double high) const {
  const bool turns = turn_ > from && turn_ < to;
  double start = from;
  for (const double end : std::array{turns ? turn_ : to, to}) {
    const double value = At(end);
    if (value >= high) return Crossing{Solve(start, end, high), 1};
    if (value <= low) return Crossing{Solve(start, end, low), -1};
    start = end;
  }
  return std::nullopt;
}

// Newton's method, with the chord for a start and kept within the bracket.
double StepSignal::Solve(double from, double to, double level) const {
  const double at_from = At(from) - level;
  const double at_to = At(to) - level;
  if (at_from * at_to >= 0.0) return std::abs(at_from) < std::abs(at_to) ? from : to;  // one of them is a rounding away
  double t = from + (to - from) * at_from / (at_from - at_to);
  for (int i = 0; i < kMaxIterations; ++i) {
    const double error = At(t) - level;
    (error * at_from > 0.0 ? from : to) = t;
    double next = t - error / Slope(t);
    if (!(next >= from && next <= to)) next = 0.5 * (from + to);
    if (std::abs(next - t) < kPrecision) return next;
    t = next;
  }
  return t;
}

}  // namespace evo
