#include "evo/tracking/depth_samples.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace evo {

namespace {

constexpr double kReachPx = 70.0;      // farther samples are rarely of the same surface
constexpr double kUsualError = 0.06;   // of an inverse depth, as a share of it
constexpr double kUsualSlope = 0.06;   // 1/px, as a share of the inverse depth
constexpr double kLeastSupport = 2.0;  // samples that agree, weighted
constexpr double kWidest = 8.0;        // the first loss over the last
constexpr int kIterations = 6;
constexpr int kNearest = 5;  // samples asked for what is usual

struct Neighbour {
  Eigen::Vector2d away;  // px
  double nearer;         // its inverse depth over that of the centre, less 1
  double weight;
};

}  // namespace

std::optional<Eigen::Vector2d> SurfaceSlope(const std::vector<DepthSample>& samples, const DepthSample& at) {
  if (!(at.inverse_depth > 0.0)) return std::nullopt;
  thread_local std::vector<Neighbour> neighbours;
  neighbours.clear();
  for (const auto& sample : samples) {
    const Eigen::Vector2d away = sample.position - at.position;
    const double distance = away.squaredNorm() / (kReachPx * kReachPx);
    if (distance >= 1.0 || distance == 0.0 || !(sample.inverse_depth > 0.0)) continue;
    neighbours.push_back({away, sample.inverse_depth / at.inverse_depth - 1.0, 1.0 - distance});
  }
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double support = 0.0;
  double width = kWidest * kUsualError;
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix2d normal = kUsualError * kUsualError / (kUsualSlope * kUsualSlope) * Eigen::Matrix2d::Identity();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    support = 0.0;
    for (const auto& [away, nearer, weight] : neighbours) {
      const double residual = (nearer - slope.dot(away)) / (width * (1.0 + std::max(0.0, nearer)));
      const double w = weight / (1.0 + residual * residual);
      normal += w * away * away.transpose();
      right += w * nearer * away;
      support += w;
    }
    slope = normal.inverse() * right;
    width = std::max(0.5 * width, kUsualError);
  }
  if (support < kLeastSupport) return std::nullopt;
  return at.inverse_depth * slope;
}

std::optional<double> UsualInverseDepth(std::vector<DepthSample> samples, const Eigen::Vector2d& position) {
  std::erase_if(samples, [](const DepthSample& sample) { return !(sample.inverse_depth > 0.0); });
  if (samples.size() < static_cast<std::size_t>(kNearest)) return std::nullopt;
  const auto distance = [&](const DepthSample& sample) { return (sample.position - position).squaredNorm(); };
  const auto end = samples.begin() + kNearest;
  std::ranges::nth_element(samples, end - 1, {}, distance);
  const auto middle = samples.begin() + kNearest / 2;
  std::nth_element(samples.begin(), middle, end,
                   [](const auto& a, const auto& b) { return a.inverse_depth < b.inverse_depth; });
  return middle->inverse_depth;
}

}  // namespace evo
