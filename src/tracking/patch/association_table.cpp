#include "tracking/patch/association_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <tuple>

#include "tracking/patch/histogram_smoother.hpp"
#include "tracking/patch/simd8.hpp"

namespace evo::tracking {

namespace {

// The mean shift is unreliable where the density is nearly flat and nearly zero; so many sigmas limit it.
constexpr float kMaxShiftSigmas = 2.5f;
// Events per cell, so that an empty histogram divides by no zero.
constexpr double kMinOutlierDensity = 1e-12;

/// Smooths the planes of histograms of one size with one Gaussian, and weighs their cells. Each thread keeps its own.
class DensitySmoother : public HistogramSmoother {
 public:
  DensitySmoother(int side, double sigma_px, AssociationTable::Weighting weighting)
      : HistogramSmoother(side, sigma_px), weights_(static_cast<std::size_t>(side * width())) {
    const int radius = side / 2;
    for (int r = 1; r + 1 < side; ++r) {
      for (int c = 1; c + 1 < side; ++c) {
        const double distance = std::hypot(r - radius, c - radius) / radius;
        const double epanechnikov = std::max(0.0, 1.0 - distance * distance);
        const double weight = weighting == AssociationTable::Weighting::kUniform ? 1.0 : epanechnikov * epanechnikov;
        weights_[static_cast<std::size_t>(r * width() + c)] = static_cast<float>(weight);
        total_weight_ += static_cast<float>(weight);
      }
    }
  }

  static DensitySmoother& ForThread(int side, double sigma_px, AssociationTable::Weighting weighting) {
    thread_local std::map<std::tuple<int, double, AssociationTable::Weighting>, DensitySmoother> smoothers;
    return smoothers.try_emplace({side, sigma_px, weighting}, side, sigma_px, weighting).first->second;
  }

  const float* weights() const { return weights_.data(); }  ///< side rows of width() cells
  float total_weight() const { return total_weight_; }

 private:
  std::vector<float> weights_;
  float total_weight_ = 0.0f;
};

struct ShiftModel {
  float outlier_density;  // D0, events per cell
  float half_variance;    // half of sigma^2: gradients are differences over two cells
  float max_shift;        // cells
};

/// Fills in one plane of a table of `side` x `side` cells. Writes up to seven cells beyond the end of a row. Returns
/// the sum of density x weight.
EVO_HOT float TabulateAssociations(const float* density, const float* weights, int width, int side,
                                   const ShiftModel& model, float* table) {
  const auto [outlier_density, half_variance, max_shift] = model;
  F32x8 sum{};
  for (int r = 1; r + 1 < side; ++r) {
    for (int c = 0; c < side; c += kLanes) {
      const float* const at = density + r * width + c;
      F32x8 middle, left, right, above, below, weight;
      Load(at, &middle);
      Load(at - 1, &left);
      Load(at + 1, &right);
      Load(at - width, &above);
      Load(at + width, &below);
      Load(weights + r * width + c, &weight);
      // The mean shift sigma^2 grad D / D times the inlier probability D / (D + D0).
      const F32x8 scale = weight / (middle + outlier_density);
      const F32x8 inlier = middle * scale;
      const F32x8 limit = max_shift * inlier;
      F32x8 x = half_variance * scale * (right - left);
      F32x8 y = half_variance * scale * (below - above);
      x = x < -limit ? -limit : x;
      x = x > limit ? limit : x;
      y = y < -limit ? -limit : y;
      y = y > limit ? limit : y;
      StoreRows({inlier, x, y, weight}, table + 4 * (r * side + c));
      sum += weight * middle;
    }
  }
  return Sum(sum);
}

/// Sums of votes x association x (1, u, v) over the cells of a plane that lie in the patch.
struct AssociationSums {
  F32x4 one{}, u{}, v{};
};

/// Columns [begin, end) of a histogram, relative to its centre.
struct Columns {
  explicit Columns(int radius) : limit(radius + 1), begin(-radius), end(radius + 1) {}

  /// Keeps the columns u with |a u + b| <= radius.
  EVO_INLINE void Restrict(float a, float b, float radius) {
    if (a == 0.0f) {
      if (std::abs(b) > radius) end = begin;
      return;
    }
    const float one = (radius - b) / a;
    const float other = (-radius - b) / a;
    const auto bound = static_cast<float>(limit);
    // A cast rounds positive numbers down.
    const int first = limit - static_cast<int>(bound - std::clamp(std::min(one, other), -bound, bound));
    const int last = static_cast<int>(std::clamp(std::max(one, other), -bound, bound) + bound) - limit;
    begin = std::max(begin, first);
    end = std::min(end, last + 1);
  }

  int limit;
  int begin, end;
};

EVO_HOT void AddAssociations(const float* votes, const float* table, int radius, const Eigen::Matrix2f& linear,
                             float patch_radius, AssociationSums* sums) {
  const int side = 2 * radius + 1;
  for (int r = 0; r < side; ++r) {
    const auto v = static_cast<float>(r - radius);
    Columns columns(radius);
    columns.Restrict(linear(0, 0), linear(0, 1) * v, patch_radius);
    columns.Restrict(linear(1, 0), linear(1, 1) * v, patch_radius);
    const int begin = r * side + radius + columns.begin;
    const int end = r * side + radius + columns.end;
    F32x8 one{}, by_u{}, u = F32x8{} + static_cast<float>(columns.begin);
    u += F32x8{0, 0, 0, 0, 1, 1, 1, 1};
    for (int i = begin; i < end; i += 2) {
      F32x8 association, vote;
      Load(table + 4 * i, &association);
      Join(F32x4{} + votes[i], F32x4{} + (i + 1 < end ? votes[i + 1] : 0.0f), &vote);
      association *= vote;
      one += association;
      by_u += u * association;
      u += 2.0f;
    }
    F32x4 here, next, here_by_u, next_by_u;
    Split(one, &here, &next);
    Split(by_u, &here_by_u, &next_by_u);
    sums->one += here + next;
    sums->u += here_by_u + next_by_u;
    sums->v += v * (here + next);
  }
}

}  // namespace

void AssociationTable::Build(const EventHistogram& histogram, double sigma_px, double outlier_density_ratio,
                             Weighting weighting) {
  const auto cells = static_cast<std::size_t>(histogram.planes() * histogram.side() * histogram.side());
  radius_ = histogram.radius();
  sigma_px_ = sigma_px;
  if (histogram.side() != side_ || cells_.size() < cells) {
    side_ = histogram.side();
    // The edge stays zero, and so does what is read or written beyond the last cell.
    cells_.assign(cells + static_cast<std::size_t>(side_ + kLanes), Association::Zero());
  }
  DensitySmoother& smoother = DensitySmoother::ForThread(side_, sigma_px, weighting);
  const double mean_density = histogram.Total() / static_cast<double>(cells);
  const ShiftModel model{
      .outlier_density = static_cast<float>(std::max(kMinOutlierDensity, outlier_density_ratio * mean_density)),
      .half_variance = static_cast<float>(0.5 * sigma_px * sigma_px),
      .max_shift = static_cast<float>(kMaxShiftSigmas * sigma_px)};
  for (int p = 0; p < histogram.planes(); ++p) {
    smoother.Smooth(histogram.plane(p));
    const float sum = TabulateAssociations(smoother.smooth(), smoother.weights(), smoother.width(), side_, model,
                                           cells_[static_cast<std::size_t>(p * side_ * side_)].data());
    log_even_densities_[static_cast<std::size_t>(p)] =
        std::log1p(sum / (smoother.total_weight() * model.outlier_density));
  }
}

SelfBias AssociationTable::ComputeSelfBias(const EventHistogram& histogram, const Eigen::Matrix2d& linear,
                                           double patch_radius_px) const {
  AssociationSums sums;
  for (int p = 0; p < histogram.planes(); ++p) {
    AddAssociations(histogram.plane(p), cells_[static_cast<std::size_t>(p * side_ * side_)].data(), radius_,
                    linear.cast<float>(), static_cast<float>(patch_radius_px), &sums);
  }
  if (!(sums.one[0] > 0.0f)) return SelfBias::Zero();
  SelfBias bias;
  bias << sums.one[1], sums.u[1], sums.v[1], sums.one[2], sums.u[2], sums.v[2];
  return bias / sums.one[0];
}

Eigen::Matrix2d AssociationTable::Information(const EventHistogram& histogram, const AssociationTable& other) const {
  Eigen::Array4f sum = Eigen::Array4f::Zero();  // xx, xy, yx, yy
  float weight = 0.0f;
  const float* votes = histogram.plane(0);
  for (int i = 0; i < histogram.planes() * side_ * side_; ++i) {
    const Association& one = cells_[i];
    const Association& two = other.cells_[i];
    if (!(one[3] > 0.0f)) continue;
    sum += votes[i] / one[3] * Association(one[1] * two[1], one[1] * two[2], one[2] * two[1], one[2] * two[2]);
    weight += votes[i] * one[3];
  }
  if (!(weight > 0.0f)) return Eigen::Matrix2d::Zero();
  const float across = 0.5f * (sum[1] + sum[2]);
  Eigen::Matrix2d information;
  information << sum[0], across, across, sum[3];
  return information / (weight * std::pow(sigma_px_, 4));
}

}  // namespace evo::tracking
