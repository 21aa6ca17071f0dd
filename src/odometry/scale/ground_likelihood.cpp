#include "odometry/scale/ground_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evo::odometry {

namespace {

constexpr double kGroundRatio = 0.3;       // of the tracks below the path, prior
constexpr double kBelowRatio = 0.2;        // density of tracks below the ground over that without a ground
constexpr double kBelowSigmas = 3.0;       // from here on a track is below the ground
constexpr double kBackgroundWidth = 0.3;   // of the background's kernel: far wider than a ground's scatter
constexpr double kBackgroundReach = 3.0;   // widths
constexpr double kBackgroundFloor = 0.05;  // a density that any height has

double Normal(double error, double sigma) {
  const double u = error / sigma;
  return std::exp(-0.5 * u * u) / (std::sqrt(2.0 * std::numbers::pi) * sigma);
}

double OffGround(double error, double sigma) {
  const bool is_below = error < -kBelowSigmas * sigma && error > -kMaxBelowGround;
  return (1.0 - kGroundRatio) * (is_below ? kBelowRatio : 1.0);
}

}  // namespace

GroundLikelihood::GroundLikelihood(const std::vector<GroundObservation>& observations) {
  std::vector<double> logs;
  for (const auto& o : observations) logs.push_back(std::log(o.inverse_height));
  std::vector<double> sorted = logs;
  std::ranges::sort(sorted);
  for (const double log : logs) {
    const double reach = kBackgroundReach * kBackgroundWidth;
    double density = 0.0;
    for (auto it = std::ranges::lower_bound(sorted, log - reach); it != sorted.end() && *it < log + reach; ++it) {
      density += Normal(*it - log, kBackgroundWidth);
    }
    background_.push_back(std::max(kBackgroundFloor, density / static_cast<double>(logs.size())));
  }
}

double GroundLikelihood::Ratio(std::size_t observation, double error, double sigma) const {
  return kGroundRatio * Normal(error, sigma) / background_[observation] + OffGround(error, sigma);
}

double GroundLikelihood::GroundProbability(std::size_t observation, double error, double sigma) const {
  const double on = kGroundRatio * Normal(error, sigma) / background_[observation];
  return on / (on + OffGround(error, sigma));
}

}  // namespace evo::odometry
