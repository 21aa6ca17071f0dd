#include "simulation/sensor/photoreceptor_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "simulation/fast_math.hpp"

namespace evo::simulation {

namespace {

constexpr double kTimePrecision = 1e-8;    // s; stamps have 1e-6
constexpr double kSignalPrecision = 1e-7;  // that of FastOneMinusExp
constexpr double kMaxCutOff = 1e12;        // rad/s; the low-pass has settled within any step
constexpr int kMaxIterations = 60;         // bisection alone needs 27 for a second

}  // namespace

PhotoreceptorResponse::PhotoreceptorResponse(double input, double slope, double output, double cut_off, double leak)
    : output_(output),
      lag_(input - output),
      slope_(slope),
      cut_off_(std::min(cut_off, kMaxCutOff)),
      leak_(leak),
      extremum_(std::numeric_limits<double>::infinity()) {
  const double decay = (slope_ + leak_) / (slope_ - cut_off_ * lag_);  // exp(-cut_off t) where the derivative is 0
  if (decay > 0.0 && decay < 1.0) extremum_ = -std::log(decay) / cut_off_;
}

double PhotoreceptorResponse::StepResponse(double t) const {
  return static_cast<double>(FastOneMinusExp(static_cast<float>(cut_off_ * t)));
}

double PhotoreceptorResponse::Evaluate(double t) const {
  if (t <= 0.0) return output_;
  const double response = StepResponse(t);
  return output_ + lag_ * response + slope_ * (t - response / cut_off_) + leak_ * t;
}

double PhotoreceptorResponse::Derivative(double t) const {
  const double response = StepResponse(t);
  return leak_ + slope_ * response + cut_off_ * lag_ * (1.0 - response);
}

std::optional<PhotoreceptorResponse::Crossing> PhotoreceptorResponse::FirstCrossing(double from, double to, double low,
                                                                                    double high) const {
  const bool has_extremum = extremum_ > from && extremum_ < to;
  double start = from;
  for (const double end : std::array{has_extremum ? extremum_ : to, to}) {
    const double value = Evaluate(end);
    if (value >= high) return Crossing{SolveCrossing(start, end, high), 1};
    if (value <= low) return Crossing{SolveCrossing(start, end, low), -1};
    start = end;
  }
  return std::nullopt;
}

/// Newton's method from the secant's root, safeguarded by bisection.
double PhotoreceptorResponse::SolveCrossing(double from, double to, double level) const {
  const double at_from = Evaluate(from) - level;
  const double at_to = Evaluate(to) - level;
  if (at_from * at_to >= 0.0)
    return std::abs(at_from) < std::abs(at_to) ? from : to;  // one of them is the root but for rounding
  double t = from + (to - from) * at_from / (at_from - at_to);
  for (int i = 0; i < kMaxIterations; ++i) {
    const double error = Evaluate(t) - level;
    if (std::abs(error) < kSignalPrecision) return t;
    (error * at_from > 0.0 ? from : to) = t;
    double next = t - error / Derivative(t);
    if (!(next >= from && next <= to)) next = 0.5 * (from + to);
    if (std::abs(next - t) < kTimePrecision) return next;
    t = next;
  }
  return t;
}

}  // namespace evo::simulation
