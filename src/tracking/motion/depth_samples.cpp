#include "tracking/motion/depth_samples.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "tracking/patch/lanes.hpp"

namespace evo::tracking {

namespace {

constexpr double kReachPx = 70.0;      // farther samples are rarely of the same surface
constexpr double kUsualError = 0.06;   // of an inverse depth, as a share of it
constexpr double kUsualSlope = 0.06;   // 1/px, as a share of the inverse depth
constexpr double kLeastSupport = 2.0;  // samples that agree, weighted
constexpr double kWidest = 8.0;        // the first loss over the last
constexpr int kIterations = 6;
constexpr int kNearest = 5;  // samples asked for what is usual

/// Of samples near a place.
struct Neighbours {
  std::vector<float> x, y;    // px from it
  std::vector<float> nearer;  // its inverse depth over that of the place, less 1
  std::vector<float> weight;  // from 0 far away to 1

  void Resize(std::size_t count) {
    for (auto* column : {&x, &y, &nearer, &weight}) column->resize(count);
  }

  void Find(const std::vector<DepthSample>& samples, const DepthSample& at) {
    Resize(samples.size() + 1);
    std::size_t count = 0;
    // Every sample is written, but stays only if the next one does not overwrite it: no branch to mispredict.
    for (const auto& sample : samples) {
      const Eigen::Vector2d away = sample.position - at.position;
      const double distance = away.squaredNorm() / (kReachPx * kReachPx);
      x[count] = static_cast<float>(away.x());
      y[count] = static_cast<float>(away.y());
      nearer[count] = static_cast<float>(sample.inverse_depth / at.inverse_depth - 1.0);
      weight[count] = static_cast<float>(1.0 - distance);
      const bool is_near = (distance < 1.0) & (distance > 0.0) & (sample.inverse_depth > 0.0);
      count += is_near ? 1 : 0;
    }
    Resize(count);
  }
};

/// Of the weighted least squares of a slope.
struct SlopeSums {
  float xx, xy, yy, x, y, support;
};

EVO_HOT void SumSlopes(const Neighbours& neighbours, const Eigen::Vector2f& slope, float width, SlopeSums* sums) {
  Lanes xx{}, xy{}, yy{}, sum_x{}, sum_y{}, support{};
  const float slope_x = slope.x();
  const float slope_y = slope.y();
  const Lanes zero{};
  for (std::size_t i = 0; i < neighbours.x.size(); i += kLanes) {
    Lanes x, y, nearer, weight;
    Load(neighbours.x, i, 0.0f, &x);
    Load(neighbours.y, i, 0.0f, &y);
    Load(neighbours.nearer, i, 0.0f, &nearer);
    Load(neighbours.weight, i, 0.0f, &weight);
    const Lanes usual = width * (1.0f + (nearer > zero ? nearer : zero));
    const Lanes residual = (nearer - slope_x * x - slope_y * y) / usual;
    const Lanes w = weight / (1.0f + residual * residual);
    const Lanes wx = w * x;
    const Lanes wy = w * y;
    xx += wx * x;
    xy += wx * y;
    yy += wy * y;
    sum_x += wx * nearer;
    sum_y += wy * nearer;
    support += w;
  }
  *sums = {Sum(xx), Sum(xy), Sum(yy), Sum(sum_x), Sum(sum_y), Sum(support)};
}

}  // namespace

std::optional<Eigen::Vector2d> SurfaceSlope(const std::vector<DepthSample>& samples, const DepthSample& at) {
  if (!(at.inverse_depth > 0.0)) return std::nullopt;
  thread_local Neighbours neighbours;
  neighbours.Find(samples, at);
  constexpr double kPrior = kUsualError * kUsualError / (kUsualSlope * kUsualSlope);
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  SlopeSums s{};
  double width = kWidest * kUsualError;
  for (int i = 0; i < kIterations; ++i) {
    SumSlopes(neighbours, slope.cast<float>(), static_cast<float>(width), &s);
    Eigen::Matrix2d normal;
    normal << s.xx + kPrior, s.xy, s.xy, s.yy + kPrior;
    slope = normal.inverse() * Eigen::Vector2d(s.x, s.y);
    width = std::max(0.5 * width, kUsualError);
  }
  if (s.support < kLeastSupport) return std::nullopt;
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

}  // namespace evo::tracking
