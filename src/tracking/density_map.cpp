#include "evo/tracking/density_map.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "tracking/gaussian_kernel.hpp"

namespace evo {

namespace {

// Where the density is nearly flat and nearly nothing the mean shift is unreliable: limit it to this many sigmas.
constexpr float kLongestPull = 2.5f;

constexpr int kBlock = 8;  // cells computed at a time
using Block = Eigen::Array<float, kBlock, 1>;
using BlockMap = Eigen::Map<const Block>;

}  // namespace

DensityMap::DensityMap(int radius_px, int planes)
    : radius_(radius_px), planes_(planes), cells_(static_cast<std::size_t>(planes * side() * side()), 0.0f) {}

double DensityMap::Total() const {
  Block sum = Block::Zero();
  std::size_t i = 0;
  for (; i + kBlock <= cells_.size(); i += kBlock) sum += BlockMap(&cells_[i]);
  return std::accumulate(cells_.begin() + static_cast<std::ptrdiff_t>(i), cells_.end(), static_cast<double>(sum.sum()));
}

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

DensityMap DensityMap::Warped(const Eigen::Matrix2d& linear, const Eigen::Vector2d& perspective) const {
  DensityMap warped(radius_, planes_);
  const Eigen::Matrix2f inverse = linear.inverse().cast<float>();
  const auto density = static_cast<float>(1.0 / std::abs(linear.determinant()));  // events per new cell
  for (int p = 0; p < planes_; ++p) {
    float* target = warped.cells_.data() + p * side() * side();
    for (int r = 0; r < side(); ++r) {
      for (int c = 0; c < side(); ++c, ++target) {
        const Eigen::Vector2f straight =
            inverse * Eigen::Vector2f(static_cast<float>(c - radius_), static_cast<float>(r - radius_));
        const float depth = 1.0f - perspective.cast<float>().dot(straight);  // of the centre over that of the cell
        if (!(depth > 0.0f)) continue;                                       // beyond the plane's horizon
        const Eigen::Vector2f u = straight / depth;
        const float column = u.x() + static_cast<float>(radius_);
        const float row = u.y() + static_cast<float>(radius_);
        const auto last = static_cast<float>(side() - 1);
        if (!(column >= 0.0f && row >= 0.0f && column < last && row < last)) continue;
        const int c0 = static_cast<int>(column);
        const int r0 = static_cast<int>(row);
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

void AssociationField::WeighCentre() {
  centre_.resize(static_cast<std::size_t>(side_ * side_));
  for (int r = 0, i = 0; r < side_; ++r) {
    for (int c = 0; c < side_; ++c, ++i) {
      const double distance = std::hypot(r - radius_, c - radius_) / radius_;
      const double weight = std::max(0.0, 1.0 - distance * distance);
      centre_[i] = static_cast<float>(weight * weight);
    }
  }
}

void AssociationField::Convolve(const float* in, std::ptrdiff_t step, float* out) const {
  const auto reach = static_cast<std::ptrdiff_t>(kernel_.size()) - 1;
  for (int c = 0; c < width_; c += kBlock, in += kBlock, out += kBlock) {
    Block sum = kernel_[0] * BlockMap(in);
    for (std::ptrdiff_t i = 1; i <= reach; ++i) sum += kernel_[i] * (BlockMap(in - i * step) + BlockMap(in + i * step));
    Eigen::Map<Block>{out} = sum;
  }
}

void AssociationField::Smooth(const float* plane) {
  const int reach = static_cast<int>(kernel_.size()) - 1;
  const int n = side_;
  const auto stride = static_cast<std::ptrdiff_t>(width_);
  row_.assign(static_cast<std::size_t>(width_ + 2 * reach), 0.0f);
  rows_.resize(static_cast<std::size_t>((n + 2 * reach) * width_));
  std::fill_n(rows_.begin(), reach * stride, 0.0f);
  std::fill_n(rows_.end() - reach * stride, reach * stride, 0.0f);
  for (int r = 0; r < n; ++r) {
    std::copy_n(plane + r * n, n, row_.begin() + reach);
    Convolve(row_.data() + reach, 1, rows_.data() + (r + reach) * stride);
  }
  smooth_.resize(static_cast<std::size_t>(n * width_));
  for (int r = 0; r < n; ++r) Convolve(rows_.data() + (r + reach) * stride, stride, smooth_.data() + r * stride);
}

void AssociationField::Build(const DensityMap& map, double sigma_px, double outlier_share) {
  radius_ = map.radius();
  side_ = map.side();
  sigma_px_ = sigma_px;
  const int n = side_;
  width_ = (n + kBlock - 1) / kBlock * kBlock;
  kernel_.resize(static_cast<std::size_t>(std::min(radius_, GaussianReach(sigma_px))) + 1);
  FillGaussianKernel(sigma_px, kernel_);
  const auto cells = static_cast<std::size_t>(map.planes() * n * n);
  if (table_.size() != cells) {
    table_.assign(cells, Pull::Zero());  // the cells at the edge stay zero
    WeighCentre();
  }
  const double mean_density = map.Total() / (map.planes() * n * n);
  const auto stray = static_cast<float>(std::max(1e-12, outlier_share * mean_density));
  const auto half_variance = static_cast<float>(0.5 * sigma_px * sigma_px);
  const auto longest = static_cast<float>(kLongestPull * sigma_px);
  for (int p = 0; p < map.planes(); ++p) {
    Smooth(map.plane(p));
    for (int r = 1; r + 1 < n; ++r) {
      const float* centre = centre_.data() + r * n;
      const float* density = smooth_.data() + r * width_;
      float* pull = table_[(p * n + r) * n].data();
      for (int c = 1; c + 1 < n; ++c) {
        // The mean shift variance * gradient / density, times the probability density / (density + stray).
        const float share = centre[c] / (density[c] + stray);
        const float weight = density[c] * share;
        const float limit = longest * weight;
        const float x = half_variance * share * (density[c + 1] - density[c - 1]);
        const float y = half_variance * share * (density[c + width_] - density[c - width_]);
        pull[4 * c] = weight;
        pull[4 * c + 1] = std::clamp(x, -limit, limit);
        pull[4 * c + 2] = std::clamp(y, -limit, limit);
        pull[4 * c + 3] = centre[c];
      }
    }
  }
}

Eigen::Matrix<double, 2, 3> AssociationField::OwnMoments(const DensityMap& map, const Eigen::Matrix2d& linear,
                                                         double patch_radius_px) const {
  const Eigen::Matrix2f l = linear.cast<float>();
  const auto reach = static_cast<float>(patch_radius_px);
  Eigen::Array4f sum = Eigen::Array4f::Zero(), sum_u = Eigen::Array4f::Zero(), sum_v = Eigen::Array4f::Zero();
  // The cells that can be inside.
  const Eigen::Vector2d farthest = 1.01 * patch_radius_px * linear.inverse().cwiseAbs().rowwise().sum();
  const int columns = farthest.x() < radius_ ? static_cast<int>(farthest.x()) : radius_;
  const int rows = farthest.y() < radius_ ? static_cast<int>(farthest.y()) : radius_;
  for (int p = 0; p < map.planes(); ++p) {
    const float* votes = map.plane(p);
    const Pull* pulls = table_.data() + p * side_ * side_;
    for (int r = radius_ - rows; r <= radius_ + rows; ++r) {
      const auto v = static_cast<float>(r - radius_);
      int i = r * side_ + radius_ - columns;
      for (int c = radius_ - columns; c <= radius_ + columns; ++c, ++i) {
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

Eigen::Matrix2d AssociationField::Information(const DensityMap& map, const AssociationField& other) const {
  Eigen::Array4f sum = Eigen::Array4f::Zero();  // xx, xy, yx, yy
  float weight = 0.0f;
  const float* votes = map.plane(0);
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const Pull& one = table_[i];
    const Pull& two = other.table_[i];
    if (!(one[3] > 0.0f)) continue;
    sum += votes[i] / one[3] * Pull(one[1] * two[1], one[1] * two[2], one[2] * two[1], one[2] * two[2]);
    weight += votes[i] * one[3];
  }
  if (!(weight > 0.0f)) return Eigen::Matrix2d::Zero();
  const float across = 0.5f * (sum[1] + sum[2]);
  Eigen::Matrix2d information;
  information << sum[0], across, across, sum[3];
  return information / (weight * std::pow(sigma_px_, 4));
}

}  // namespace evo
