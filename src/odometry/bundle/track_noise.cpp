#include "odometry/bundle/track_noise.hpp"

#include <algorithm>
#include <cmath>

namespace evo::odometry {

namespace {

/// Calls f(k, innovation, drift) for each error: how far it is, shrunk, from what was expected, and the drift, shrunk,
/// that is expected from then on. An infinite error counts as none.
template <typename Function>
void Filter(std::span<const InnovationStep> steps, const std::vector<Eigen::Vector2d>& errors, const Function& f) {
  Eigen::Vector2d expected = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < errors.size(); ++k) {
    Eigen::Vector2d innovation = -expected;
    if (errors[k].allFinite()) innovation += steps[k].shrink * errors[k];
    expected += steps[k].gain * innovation;
    f(k, innovation, expected);
  }
}

}  // namespace

void AppendInnovationSteps(double drift, std::span<const double> magnifications, std::vector<InnovationStep>* steps) {
  // Variances in units of the white noise's: of the drift in the long run, and before each sighting.
  const double settled = 0.5 * (drift + std::sqrt(drift * drift + 4.0 * drift));
  double variance = 0.0;
  for (const double magnification : magnifications) {
    const double shrink = 1.0 / magnification;
    const double total = variance + shrink * shrink;
    const double gain = variance / total;
    steps->push_back({shrink, gain, std::sqrt((settled + 1.0) / total)});
    variance += drift * shrink * shrink - gain * variance;
  }
}

void Innovate(std::span<const InnovationStep> steps, const std::vector<Eigen::Vector2d>& errors,
              std::vector<Eigen::Vector2d>* innovations) {
  innovations->resize(errors.size());
  Filter(steps, errors, [&](std::size_t k, const Eigen::Vector2d& innovation, const Eigen::Vector2d&) {
    (*innovations)[k] = errors[k].allFinite() ? Eigen::Vector2d(steps[k].scale * innovation) : errors[k];
  });
}

void EstimateDrift(std::span<const InnovationStep> steps, const std::vector<Eigen::Vector2d>& errors,
                   std::vector<Eigen::Vector2d>* drifts) {
  drifts->resize(errors.size());
  Filter(steps, errors, [&](std::size_t k, const Eigen::Vector2d&, const Eigen::Vector2d& drift) {
    (*drifts)[k] = drift / steps[k].shrink;
  });
}

void InformationOfErrors(std::span<const InnovationStep> steps, const std::vector<double>& weights,
                         Eigen::MatrixXd* information) {
  const auto n = static_cast<Eigen::Index>(weights.size());
  information->setZero(n, n);
  // Column by column: L on a unit vector, then the weights, then L^T by the adjoint recursion.
  thread_local std::vector<double> weighted;
  weighted.resize(weights.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    double expected = 0.0;
    Eigen::Index end = j;
    for (; end < n; ++end) {
      const InnovationStep& step = steps[end];
      const double innovation = (end == j ? step.shrink : 0.0) - expected;
      weighted[end] = weights[end] * step.scale * step.scale * innovation;
      expected += step.gain * innovation;
      if (expected == 0.0) break;
    }
    double later = 0.0;  // what the expectation after a sighting feeds into the later innovations
    for (Eigen::Index k = std::min(end + 1, n); k-- > j;) {
      const double at = weighted[k] + steps[k].gain * later;
      (*information)(k, j) = (*information)(j, k) = steps[k].shrink * at;
      later -= at;
    }
  }
}

}  // namespace evo::odometry
