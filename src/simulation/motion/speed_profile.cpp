#include "simulation/motion/speed_profile.hpp"

#include <algorithm>
#include <cmath>

namespace evo::simulation {

namespace {

constexpr double kStep = 0.005;  // s
// Two moving averages over 0.4 s: the acceleration rises within 0.8 s as a driver's does.
constexpr int kHalfWindow = 40;                         // samples
constexpr double kSupport = 2.0 * kHalfWindow * kStep;  // s: half width of both averages together
constexpr double kCell = 0.25;                          // m: resolution of the speed limit
constexpr double kTurnRadius = 8.0;                     // m: turn_speed_m_s holds there, as in ReferenceLine's "turns"

/// The speed that bends and the end of the road allow if the car brakes in time.
class SpeedLimit {
 public:
  SpeedLimit(const ReferenceLine& road, const VehicleOptions& options) : length_(road.length()) {
    const double lateral = options.turn_speed_m_s * options.turn_speed_m_s / kTurnRadius;
    const int cells = std::max(1, static_cast<int>(std::ceil(length_ / kCell)));
    cell_ = length_ / cells;
    squares_.resize(cells + 1);
    squares_[cells] = 0.0;
    for (int i = cells - 1; i >= 0; --i) {
      const double in_bend = lateral / std::max(1e-9, std::abs(road.PointAt(i * cell_).curvature));
      squares_[i] = std::min(
          {options.speed_m_s * options.speed_m_s, in_bend, squares_[i + 1] + 2.0 * options.acceleration_m_s2 * cell_});
    }
  }

  double SpeedAt(double distance) const {
    if (distance >= length_) return 0.0;
    const double x = distance / cell_;
    const auto i = std::min(static_cast<std::size_t>(x), squares_.size() - 2);
    const double u = x - static_cast<double>(i);
    return std::sqrt((1.0 - u) * squares_[i] + u * squares_[i + 1]);
  }

 private:
  double length_;
  double cell_ = 0.0;
  std::vector<double> squares_;  ///< (m/s)^2, one a cell border
};

/// Means over 2 kHalfWindow + 1 samples; the result is shorter by 2 kHalfWindow.
std::vector<double> MovingAverage(const std::vector<double>& values) {
  std::vector<double> sums(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i];
  constexpr std::size_t kWidth = 2 * kHalfWindow + 1;
  std::vector<double> means;
  for (std::size_t i = 0; i + kWidth < sums.size(); ++i) means.push_back((sums[i + kWidth] - sums[i]) / kWidth);
  return means;
}

}  // namespace

SpeedProfile::SpeedProfile(const ReferenceLine& road, const VehicleOptions& options) {
  const int samples = static_cast<int>(std::ceil(options.duration_s / kStep)) + 2;
  speeds_ = MovingAverage(MovingAverage(IntegrateSpeeds(road, options, samples + 4 * kHalfWindow)));
  distances_.assign(speeds_.size(), 0.0);
  for (std::size_t i = 1; i < speeds_.size(); ++i) {
    distances_[i] = distances_[i - 1] + 0.5 * kStep * (speeds_[i - 1] + speeds_[i]);
  }
}

std::vector<double> SpeedProfile::IntegrateSpeeds(const ReferenceLine& road, const VehicleOptions& options,
                                                  int samples) {
  const SpeedLimit limit(road, options);
  const bool rests = options.start_at_rest_s > 0.0;
  // The averages shorten a stand by kSupport at each of its ends.
  double stands_until = rests ? options.start_at_rest_s + kSupport : 0.0;
  double next_stop = options.stop_every_s > 0.0 ? options.stop_every_s : 1e300;
  bool braking = false;
  double distance = 0.0;
  double speed = rests ? 0.0 : limit.SpeedAt(0.0);
  std::vector<double> speeds;
  for (int i = 0; i < samples; ++i) {
    const double t = i * kStep - kSupport;
    speeds.push_back(speed);
    if (t < 0.0) continue;  // at rest or at full speed, so that the average is at 0, too
    if (t >= next_stop) {
      braking = t >= stands_until;
      while (t >= next_stop) next_stop += options.stop_every_s;
    }
    if (t < stands_until) continue;
    const double change = options.acceleration_m_s2 * kStep;
    const double desired = braking ? std::max(0.0, speed - change) : speed + change;
    const double next = std::min(desired, limit.SpeedAt(distance + kStep * speed));
    distance += 0.5 * kStep * (speed + next);
    speed = next;
    if (braking && speed == 0.0) {
      braking = false;
      stands_until = t + options.stand_s + 2.0 * kSupport;
    }
  }
  return speeds;
}

double SpeedProfile::SpeedAt(double t_s) const {
  const double x = std::clamp(t_s / kStep, 0.0, static_cast<double>(speeds_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(x), speeds_.size() - 2);
  const double u = x - static_cast<double>(i);
  return (1.0 - u) * speeds_[i] + u * speeds_[i + 1];
}

double SpeedProfile::DistanceAt(double t_s) const {
  const double x = t_s / kStep;
  const auto last = static_cast<double>(speeds_.size() - 1);
  if (x <= 0.0) return t_s * speeds_.front();
  if (x >= last) return distances_.back() + (t_s - last * kStep) * speeds_.back();
  const auto i = static_cast<std::size_t>(x);
  const double u = x - static_cast<double>(i);
  return distances_[i] + kStep * u * (speeds_[i] + 0.5 * u * (speeds_[i + 1] - speeds_[i]));
}

}  // namespace evo::simulation
