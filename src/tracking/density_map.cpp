#include "evo/tracking/density_map.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace evo {

namespace {

// Where the density is nearly flat and nearly nothing the mean shift is unreliable: limit it to this many sigmas.
constexpr float kLongestPull = 2.5f;

}  // namespace

DensityMap::DensityMap(int radius_px, int planes)
    : radius_(radius_px), planes_(planes), cells_(static_cast<std::size_t>(planes * side() * side()), 0.0f) {}

double DensityMap::Total() const { return std::accumulate(cells_.begin(), cells_.end(), 0.0); }

double DensityMap::EffectiveCells() const {
  const double squares = std::inner_product(cells_.begin(), cells_.end(), cells_.begin(), 0.0);
  const double total = Total();
  return squares > 0.0 ? total * total / squares : 0.0;
}

void DensityMap::Clear() { std::ranges::fill(cells_, 0.0f); }

void DensityMap::Scale(float factor) {
  for (float& cell : cells_) cell *= factor;
}

void DensityMap::Add(const DensityMap& other, float factor) {
  for (std::size_t i = 0; i < cells_.size(); ++i) cells_[i] += factor * other.cells_[i];
}

DensityMap DensityMap::Warped(const Eigen::Matrix2d& linear) const {
  DensityMap warped(radius_, planes_);
  const Eigen::Matrix2f inverse = linear.inverse().cast<float>();
  const auto density = static_cast<float>(1.0 / std::abs(linear.determinant()));  // events per new cell
  for (int p = 0; p < planes_; ++p) {
    float* target = warped.cells_.data() + p * side() * side();
    for (int r = 0; r < side(); ++r) {
      for (int c = 0; c < side(); ++c, ++target) {
        const Eigen::Vector2f u =
            inverse * Eigen::Vector2f(static_cast<float>(c - radius_), static_cast<float>(r - radius_));
        const float column = u.x() + static_cast<float>(radius_);
        const float row = u.y() + static_cast<float>(radius_);
        const int c0 = static_cast<int>(column);
        const int r0 = static_cast<int>(row);
        if (!(column >= 0.0f && row >= 0.0f) || c0 >= side() - 1 || r0 >= side() - 1) continue;
        const float fx = column - static_cast<float>(c0);
        const float fy = row - static_cast<float>(r0);
        const float* cell = plane(p) + r0 * side() + c0;
        *target = density * ((1.0f - fy) * ((1.0f - fx) * cell[0] + fx * cell[1]) +
                             fy * ((1.0f - fx) * cell[side()] + fx * cell[side() + 1]));
      }
    }
  }
  return warped;
}

void AssociationField::Smooth(const float* plane, double sigma_px) {
  const int reach = std::min(radius_, static_cast<int>(std::ceil(3.0 * sigma_px)));
  kernel_.resize(static_cast<std::size_t>(reach) + 1);
  float sum = 0.0f;
  for (int i = 0; i <= reach; ++i) {
    kernel_[i] = static_cast<float>(std::exp(-0.5 * i * i / (sigma_px * sigma_px)));
    sum += i ? 2.0f * kernel_[i] : kernel_[i];
  }
  for (float& k : kernel_) k /= sum;

  const int n = side_;
  rows_.assign(static_cast<std::size_t>(n * n), 0.0f);
  smooth_.assign(static_cast<std::size_t>(n * n), 0.0f);
  for (int r = 0; r < n; ++r) {
    const float* in = plane + r * n;
    float* out = rows_.data() + r * n;
    for (int i = -reach; i <= reach; ++i) {
      const float k = kernel_[std::abs(i)];
      const int begin = std::max(0, -i);
      const int end = std::min(n, n - i);
      for (int c = begin; c < end; ++c) out[c] += k * in[c + i];
    }
  }
  for (int r = 0; r < n; ++r) {
    float* out = smooth_.data() + r * n;
    for (int i = std::max(-reach, -r); i <= std::min(reach, n - 1 - r); ++i) {
      const float k = kernel_[std::abs(i)];
      const float* in = rows_.data() + (r + i) * n;
      for (int c = 0; c < n; ++c) out[c] += k * in[c];
    }
  }
}

void AssociationField::Build(const DensityMap& map, double sigma_px, double outlier_share) {
  radius_ = map.radius();
  side_ = map.side();
  const int n = side_;
  table_.assign(static_cast<std::size_t>(map.planes() * n * n), Pull::Zero());
  const double mean_density = map.Total() / (map.planes() * n * n);
  const auto stray = static_cast<float>(std::max(1e-12, outlier_share * mean_density));
  const auto variance = static_cast<float>(sigma_px * sigma_px);
  const auto longest = static_cast<float>(kLongestPull * sigma_px);
  for (int p = 0; p < map.planes(); ++p) {
    Smooth(map.plane(p), sigma_px);
    for (int r = 1; r + 1 < n; ++r) {
      const auto density = [&](int dr, int dc) {
        return Eigen::Map<const Eigen::ArrayXf>(smooth_.data() + (r + dr) * n + 1 + dc, n - 2);
      };
      weight_ = density(0, 0) / (density(0, 0) + stray);
      y_ = 0.5f * variance / (density(0, 0) + 1e-3f * stray);
      x_ = y_ * (density(0, 1) - density(0, -1));
      y_ *= density(1, 0) - density(-1, 0);
      scale_ = weight_ * longest / (x_.square() + y_.square()).max(longest * longest).sqrt();
      x_ *= scale_;
      y_ *= scale_;
      Pull* row = table_.data() + (p * n + r) * n + 1;
      for (int c = 0; c < n - 2; ++c) row[c] = Pull(weight_[c], x_[c], y_[c], 0.0f);
    }
  }
}

Eigen::Matrix<double, 2, 3> AssociationField::OwnMoments(const DensityMap& map, const Eigen::Matrix2d& linear,
                                                         double patch_radius_px) const {
  const Eigen::Matrix2f l = linear.cast<float>();
  const auto reach = static_cast<float>(patch_radius_px);
  Eigen::Array4f sum = Eigen::Array4f::Zero(), sum_u = Eigen::Array4f::Zero(), sum_v = Eigen::Array4f::Zero();
  for (int p = 0; p < map.planes(); ++p) {
    const float* votes = map.plane(p);
    const Pull* pulls = table_.data() + p * side_ * side_;
    for (int r = 0, i = 0; r < side_; ++r) {
      const auto v = static_cast<float>(r - radius_);
      for (int c = 0; c < side_; ++c, ++i) {
        const auto u = static_cast<float>(c - radius_);
        if (std::abs(l(0, 0) * u + l(0, 1) * v) > reach || std::abs(l(1, 0) * u + l(1, 1) * v) > reach) continue;
        const Pull pull = votes[i] * pulls[i];
        sum += pull;
        sum_u += u * pull;
        sum_v += v * pull;
      }
    }
  }
  if (!(sum[0] > 0.0f)) return Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, 3> moments;
  moments << sum[1], sum_u[1], sum_v[1], sum[2], sum_u[2], sum_v[2];
  return moments / sum[0];
}

}  // namespace evo
