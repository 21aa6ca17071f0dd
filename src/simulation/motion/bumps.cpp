#include "simulation/motion/bumps.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "simulation/smoother_step.hpp"

namespace evo::simulation {

namespace {

// A passenger car: body bounce lies between 1 Hz and 2 Hz, the damping ratio between 0.2 and 0.4 (T. D. Gillespie,
// Fundamentals of Vehicle Dynamics, 1992).
constexpr double kFrequencyHz = 1.8;
constexpr double kDampingRatio = 0.35;
constexpr double kOnset = 0.15;  // s in which the wheel climbs the bump: velocity stays continuous

constexpr double kMinPeriod = 0.1;  // s: bumps that come faster make a vibration

std::optional<double> ParseSeconds(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  double value = 0.0;
  const auto [last, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || last != text.data() + text.size() || !std::isfinite(value) || value < 0.0) return {};
  return value;
}

std::optional<std::vector<double>> ParsePeriodicTimes(std::string_view period_text, double duration_s) {
  const auto period = ParseSeconds(period_text);
  if (!period || *period < kMinPeriod) return {};
  std::vector<double> times;
  for (int i = 1; i * *period <= duration_s; ++i) times.push_back(i * *period);
  return times;
}

}  // namespace

std::optional<std::vector<double>> ParseBumpTimes(std::string_view text, double duration_s) {
  constexpr std::string_view kEvery = "every ";
  std::vector<double> times;
  if (text.empty()) return times;
  if (text.starts_with(kEvery)) return ParsePeriodicTimes(text.substr(kEvery.size()), duration_s);
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const auto time = ParseSeconds(text.substr(from, comma - from));
    if (!time) return {};
    if (*time <= duration_s) times.push_back(*time);
    from = comma + 1;
  }
  std::ranges::sort(times);
  return times;
}

double BumpResponse(double t) {
  constexpr double kOmega = 2.0 * std::numbers::pi * kFrequencyHz;
  const double damped = kOmega * std::sqrt(1.0 - kDampingRatio * kDampingRatio);
  return SmootherStep(t / kOnset) * std::exp(-kDampingRatio * kOmega * t) * std::sin(damped * t);
}

double BumpResponsePeak() {
  double peak = 0.0;
  for (double t = 0.0; t < 0.5 / kFrequencyHz; t += 1e-4) peak = std::max(peak, BumpResponse(t));
  return peak;
}

}  // namespace evo::simulation
