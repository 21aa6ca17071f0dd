#include "odometry/bundle/whitening_filter.hpp"

#include <algorithm>
#include <cmath>

namespace evo::odometry {

namespace {

/// Calls visit(k, innovation, drift) for each error: the innovation before normalisation and the drift predicted from
/// it, both over the magnification. An infinite error counts as missing.
template <typename Visitor>
void FilterDrift(std::span<const WhiteningStep> steps, const std::vector<Eigen::Vector2d>& errors,
                 const Visitor& visit) {
  Eigen::Vector2d drift = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < errors.size(); ++k) {
    Eigen::Vector2d innovation = -drift;
    if (errors[k].allFinite()) innovation += steps[k].inverse_magnification * errors[k];
    drift += steps[k].kalman_gain * innovation;
    visit(k, innovation, drift);
  }
}

}  // namespace

void AppendWhiteningSteps(double drift_variance_ratio, std::span<const double> magnifications,
                          std::vector<WhiteningStep>* steps) {
  // Variances in units of the white noise's: the drift's in steady state (the scalar Riccati equation) and before each
  // observation.
  const double steady_variance =
      0.5 *
      (drift_variance_ratio + std::sqrt(drift_variance_ratio * drift_variance_ratio + 4.0 * drift_variance_ratio));
  double variance = 0.0;
  for (const double magnification : magnifications) {
    const double inverse = 1.0 / magnification;
    const double innovation_variance = variance + inverse * inverse;
    const double gain = variance / innovation_variance;
    steps->push_back({inverse, gain, std::sqrt((steady_variance + 1.0) / innovation_variance)});
    variance += drift_variance_ratio * inverse * inverse - gain * variance;
  }
}

void ComputeInnovations(std::span<const WhiteningStep> steps, const std::vector<Eigen::Vector2d>& errors,
                        std::vector<Eigen::Vector2d>* innovations) {
  innovations->resize(errors.size());
  FilterDrift(steps, errors, [&](std::size_t k, const Eigen::Vector2d& innovation, const Eigen::Vector2d&) {
    (*innovations)[k] = errors[k].allFinite() ? Eigen::Vector2d(steps[k].normalization * innovation) : errors[k];
  });
}

void EstimateDrift(std::span<const WhiteningStep> steps, const std::vector<Eigen::Vector2d>& errors,
                   std::vector<Eigen::Vector2d>* drifts) {
  drifts->resize(errors.size());
  FilterDrift(steps, errors, [&](std::size_t k, const Eigen::Vector2d&, const Eigen::Vector2d& drift) {
    (*drifts)[k] = drift / steps[k].inverse_magnification;
  });
}

void ComputeErrorInformation(std::span<const WhiteningStep> steps, const std::vector<double>& innovation_weights,
                             Eigen::MatrixXd* information) {
  const auto n = static_cast<Eigen::Index>(innovation_weights.size());
  information->setZero(n, n);
  // Column by column: L times a unit vector, then the weights, then L^T by the adjoint recursion.
  thread_local std::vector<double> weighted;
  weighted.resize(innovation_weights.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    double drift = 0.0;
    Eigen::Index end = j;
    for (; end < n; ++end) {
      const WhiteningStep& step = steps[end];
      const double innovation = (end == j ? step.inverse_magnification : 0.0) - drift;
      weighted[end] = innovation_weights[end] * step.normalization * step.normalization * innovation;
      drift += step.kalman_gain * innovation;
      if (drift == 0.0) break;
    }
    double adjoint = 0.0;  // derivative of the later innovations by the drift after this observation
    for (Eigen::Index k = std::min(end + 1, n); k-- > j;) {
      const double row = weighted[k] + steps[k].kalman_gain * adjoint;
      (*information)(k, j) = (*information)(j, k) = steps[k].inverse_magnification * row;
      adjoint -= row;
    }
  }
}

}  // namespace evo::odometry
