#include "odometry/bundle/track_weights.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evo/core/median.hpp"

namespace evo::odometry {

namespace {

constexpr double kSmallestSigmaPx = 0.05;
constexpr double kUsualFreedom = 10.0;  // degrees of freedom that the usual noise counts as
constexpr double kPointFreedom = 3.0;   // what a point's numbers take of them

}  // namespace

double MeasureNoise(const std::vector<Eigen::Vector2d>& errors) {
  std::vector<double> norms;
  for (const auto& error : errors) norms.push_back(error.norm());
  return std::max(kSmallestSigmaPx, kMedianNormToSigma * Median(std::move(norms)));
}

void WeighTracks(double drift, BundleProblem* problem) {
  for (BundlePoint& point : problem->points) point.weight = 1.0;
  const auto innovations = BundleInnovations(*problem, drift);
  const double sigma_px = MeasureNoise(innovations);
  std::vector<double> squares(problem->points.size()), freedom(problem->points.size(), -kPointFreedom);
  for (std::size_t i = 0; i < innovations.size(); ++i) {
    const int point = problem->observations[i].point;
    squares[point] += std::min(innovations[i].squaredNorm() / (sigma_px * sigma_px), kOutlierSigmas * kOutlierSigmas);
    freedom[point] += 2.0;
  }
  std::vector<double> weights;  // of the points that are seen
  for (std::size_t p = 0; p < squares.size(); ++p) {
    if (squares[p] == 0.0) continue;
    const double variance = (kUsualFreedom + squares[p]) / (kUsualFreedom + std::max(0.0, freedom[p]));
    problem->points[p].weight = 1.0 / std::sqrt(variance);
    weights.push_back(problem->points[p].weight);
  }
  const double usual = Median(weights);
  if (usual == 0.0) return;
  for (BundlePoint& point : problem->points) point.weight /= usual;
}

}  // namespace evo::odometry
