#include "simulation/sensor/step_signal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "simulation/render/fast_math.hpp"

namespace evo::simulation {

namespace {

constexpr double kTimePrecision = 1e-8;    // s
constexpr double kSignalPrecision = 1e-7;  // as of FastOneMinusExp
constexpr double kHighestCutOff = 1e12;    // as good as none
constexpr int kMaxIterations = 60;

}  // namespace

StepSignal::StepSignal(double input, double slope, double output, double cut_off, double leak)
    : output_(output),
      lag_(input - output),
      slope_(slope),
      cut_off_(std::min(cut_off, kHighestCutOff)),
      leak_(leak),
      turn_(std::numeric_limits<double>::infinity()) {
  const double decay = (slope_ + leak_) / (slope_ - cut_off_ * lag_);  // where the derivative is 0
  if (decay > 0.0 && decay < 1.0) turn_ = -std::log(decay) / cut_off_;
}

double StepSignal::Share(double t) const {
  return static_cast<double>(FastOneMinusExp(static_cast<float>(cut_off_ * t)));
}

double StepSignal::At(double t) const {
  if (t <= 0.0) return output_;
  const double share = Share(t);
  return output_ + lag_ * share + slope_ * (t - share / cut_off_) + leak_ * t;
}

double StepSignal::Slope(double t) const {
  const double share = Share(t);
  return leak_ + slope_ * share + cut_off_ * lag_ * (1.0 - share);
}

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
    if (std::abs(error) < kSignalPrecision) return t;
    (error * at_from > 0.0 ? from : to) = t;
    double next = t - error / Slope(t);
    if (!(next >= from && next <= to)) next = 0.5 * (from + to);
    if (std::abs(next - t) < kTimePrecision) return next;
    t = next;
  }
  return t;
}

}  // namespace evo::simulation
