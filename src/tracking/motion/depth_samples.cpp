#include "tracking/motion/depth_samples.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "tracking/patch/simd8.hpp"

namespace evo::tracking {

namespace {

constexpr double kMaxDistancePx = 70.0;      // samples farther away rarely lie on the same surface
constexpr double kInverseDepthError = 0.06;  // standard deviation, relative to the inverse depth
constexpr double kTypicalGradient = 0.06;    // standard deviation, relative to the inverse depth, 1/px
constexpr double kMinSupport = 2.0;          // sum of the weights of the samples that agree
constexpr double kFirstWidth = 8.0;          // of the robust loss, over the last width
constexpr int kIterations = 6;
constexpr int kMedianSamples = 5;

/// Samples near a place.
struct Neighbours {
  std::vector<float> x, y;       // relative to the place, px
  std::vector<float> deviation;  // of the inverse depth, relative to that of the place
  std::vector<float> weight;     // from 0 at the largest distance to 1

  void Resize(std::size_t count) {
    for (auto* column : {&x, &y, &deviation, &weight}) column->resize(count);
  }

  void Find(const std::vector<DepthSample>& samples, const DepthSample& at) {
    Resize(samples.size() + 1);
    std::size_t count = 0;
    // Every sample is written, and the next one overwrites it unless it is near: no branch to mispredict.
    for (const auto& sample : samples) {
      const Eigen::Vector2d offset = sample.position - at.position;
      const double distance = offset.squaredNorm() / (kMaxDistancePx * kMaxDistancePx);
      x[count] = static_cast<float>(offset.x());
      y[count] = static_cast<float>(offset.y());
      deviation[count] = static_cast<float>(sample.inverse_depth / at.inverse_depth - 1.0);
      weight[count] = static_cast<float>(1.0 - distance);
      const bool is_near = (distance < 1.0) & (distance > 0.0) & (sample.inverse_depth > 0.0);
      count += is_near ? 1 : 0;
    }
    Resize(count);
  }
};

/// Normal equations of a gradient.
struct GradientSums {
  float xx, xy, yy, x, y, support;
};

/// Sums with the Cauchy weights at `gradient`. Eight floats at a time, so neither SolveRobust nor CauchyWeight.
EVO_HOT void SumWeighted(const Neighbours& neighbours, const Eigen::Vector2f& gradient, float width,
                         GradientSums* sums) {
  F32x8 xx{}, xy{}, yy{}, sum_x{}, sum_y{}, support{};
  const float gradient_x = gradient.x();
  const float gradient_y = gradient.y();
  const F32x8 zero{};
  for (std::size_t i = 0; i < neighbours.x.size(); i += kLanes) {
    F32x8 x, y, deviation, weight;
    Load(neighbours.x, i, 0.0f, &x);
    Load(neighbours.y, i, 0.0f, &y);
    Load(neighbours.deviation, i, 0.0f, &deviation);
    Load(neighbours.weight, i, 0.0f, &weight);
    const F32x8 sigma = width * (1.0f + (deviation > zero ? deviation : zero));
    const F32x8 residual = (deviation - gradient_x * x - gradient_y * y) / sigma;
    const F32x8 w = weight / (1.0f + residual * residual);
    const F32x8 wx = w * x;
    const F32x8 wy = w * y;
    xx += wx * x;
    xy += wx * y;
    yy += wy * y;
    sum_x += wx * deviation;
    sum_y += wy * deviation;
    support += w;
  }
  *sums = {Sum(xx), Sum(xy), Sum(yy), Sum(sum_x), Sum(sum_y), Sum(support)};
}

}  // namespace

std::optional<Eigen::Vector2d> FitInverseDepthGradient(const std::vector<DepthSample>& samples, const DepthSample& at) {
  if (!(at.inverse_depth > 0.0)) return std::nullopt;
  thread_local Neighbours neighbours;
  neighbours.Find(samples, at);
  constexpr double kPrior = kInverseDepthError * kInverseDepthError / (kTypicalGradient * kTypicalGradient);
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  GradientSums s{};
  double width = kFirstWidth * kInverseDepthError;
  for (int i = 0; i < kIterations; ++i) {
    SumWeighted(neighbours, gradient.cast<float>(), static_cast<float>(width), &s);
    Eigen::Matrix2d normal;
    normal << s.xx + kPrior, s.xy, s.xy, s.yy + kPrior;
    gradient = normal.inverse() * Eigen::Vector2d(s.x, s.y);
    width = std::max(0.5 * width, kInverseDepthError);
  }
  if (s.support < kMinSupport) return std::nullopt;
  return at.inverse_depth * gradient;
}

std::optional<double> MedianInverseDepth(std::vector<DepthSample> samples, const Eigen::Vector2d& position) {
  std::erase_if(samples, [](const DepthSample& sample) { return !(sample.inverse_depth > 0.0); });
  if (samples.size() < static_cast<std::size_t>(kMedianSamples)) return std::nullopt;
  const auto distance = [&](const DepthSample& sample) { return (sample.position - position).squaredNorm(); };
  const auto end = samples.begin() + kMedianSamples;
  std::ranges::nth_element(samples, end - 1, {}, distance);
  const auto middle = samples.begin() + kMedianSamples / 2;
  std::nth_element(samples.begin(), middle, end,
                   [](const auto& a, const auto& b) { return a.inverse_depth < b.inverse_depth; });
  return middle->inverse_depth;
}

}  // namespace evo::tracking
