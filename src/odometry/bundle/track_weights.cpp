#include "odometry/bundle/track_weights.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evo/core/median.hpp"
#include "odometry/bundle/reprojection.hpp"

namespace evo::odometry {

namespace {

constexpr double kMinSigmaPx = 0.05;             // below what any tracker reaches; keeps widths and ratios finite
constexpr double kPriorDegreesOfFreedom = 10.0;  // of the typical noise: about a track of five frames
constexpr double kPointDegreesOfFreedom = 3.0;   // fitted to the track's errors

}  // namespace

double EstimateNoise(const std::vector<Eigen::Vector2d>& errors_px) {
  std::vector<double> norms;
  for (const auto& error : errors_px) norms.push_back(error.norm());
  return std::max(kMinSigmaPx, kMedianNormToSigma * Median(std::move(norms)));
}

void SetTrackWeights(double drift_variance_ratio, BundleProblem* problem) {
  for (BundlePoint& point : problem->points) point.weight = 1.0;
  const auto innovations = ReprojectionInnovations(*problem, drift_variance_ratio);
  const double sigma_px = EstimateNoise(innovations);
  std::vector<double> squares(problem->points.size());
  std::vector<double> degrees_of_freedom(problem->points.size(), -kPointDegreesOfFreedom);
  for (std::size_t i = 0; i < innovations.size(); ++i) {
    const int point = problem->observations[i].point;
    squares[point] += std::min(innovations[i].squaredNorm() / (sigma_px * sigma_px), kOutlierSigmas * kOutlierSigmas);
    degrees_of_freedom[point] += 2.0;
  }
  std::vector<double> weights;  // of the observed points
  for (std::size_t p = 0; p < squares.size(); ++p) {
    if (squares[p] == 0.0) continue;
    const double variance =
        (kPriorDegreesOfFreedom + squares[p]) / (kPriorDegreesOfFreedom + std::max(0.0, degrees_of_freedom[p]));
    problem->points[p].weight = 1.0 / std::sqrt(variance);
    weights.push_back(problem->points[p].weight);
  }
  const double typical = Median(weights);
  if (typical == 0.0) return;
  for (BundlePoint& point : problem->points) point.weight /= typical;
}

}  // namespace evo::odometry
