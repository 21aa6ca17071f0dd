#include "tracking/patch/density_map.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <tuple>

#include "tracking/patch/event_lanes.hpp"
#include "tracking/patch/gaussian_kernel.hpp"

namespace evo::tracking {

namespace {

// Where the density is nearly flat and nearly nothing the mean shift is unreliable: limit it to this many sigmas.
constexpr float kLongestPull = 2.5f;

/// What pulls an event, for a plane of smoothed densities `width` cells wide, with the weights of the same cells; as
/// many rows. Writes up to seven cells beyond the end of a row of the table.
EVO_HOT void TabulatePulls(const float* density, const float* centre, int width, int side, float stray,
                           float half_variance, float longest, float* table) {
  for (int r = 1; r + 1 < side; ++r) {
    for (int c = 0; c < side; c += kLanes) {
      const float* const at = density + r * width + c;
      Lanes middle, left, right, above, below, weigh;
      Load(at, &middle);
      Load(at - 1, &left);
      Load(at + 1, &right);
      Load(at - width, &above);
      Load(at + width, &below);
      Load(centre + r * width + c, &weigh);
      // The mean shift variance * gradient / density, times the probability density / (density + stray).
      const Lanes share = weigh / (middle + stray);
      const Lanes weight = middle * share;
      const Lanes limit = longest * weight;
      Lanes x = half_variance * share * (right - left);
      Lanes y = half_variance * share * (below - above);
      x = x < -limit ? -limit : x;
      x = x > limit ? limit : x;
      y = y < -limit ? -limit : y;
      y = y > limit ? limit : y;
      StoreRows({weight, x, y, weigh}, table + 4 * (r * side + c));
    }
  }
}

EVO_HOT void BlendCells(float keep, const float* other, float factor, std::span<float> cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = keep * cells[i] + factor * other[i];
}

}  // namespace

DensityMap::DensityMap(int radius_px, int planes)
    : radius_(radius_px), planes_(planes), cells_(static_cast<std::size_t>(planes * side() * side()), 0.0f) {}

double DensityMap::EffectiveCells() const {
  const double squares = std::inner_product(cells_.begin(), cells_.end(), cells_.begin(), 0.0);
  return squares > 0.0 ? total_ * total_ / squares : 0.0;
}

void DensityMap::Clear() {
  std::ranges::fill(cells_, 0.0f);
  total_ = 0.0;
}

namespace {

/// Returns how many fell inside.
EVO_HOT std::int32_t VoteInto(float* cells, int radius, std::int32_t second, std::span<const float> x,
                              std::span<const float> y, std::span<const std::int8_t> polarity) {
  const std::ptrdiff_t side = 2 * radius + 1;
  const auto reach = static_cast<float>(radius);
  const auto width = static_cast<float>(side);
  const Lanes zero{};
  const Lanes last = zero + static_cast<float>(2 * radius);
  LaneInts votes{};
  const auto vote = [&](std::int32_t plane, std::int32_t cell, float w00, float w01, float w10, float w11) {
    float* const at = cells + plane + cell;
    at[0] += w00;
    at[1] += w01;
    at[side] += w10;
    at[side + 1] += w11;
  };
  for (std::size_t begin = 0; begin < x.size(); begin += kLanes) {
    const std::size_t count = std::min<std::size_t>(kLanes, x.size() - begin);
    Lanes column, row;
    Load(x, begin, kOutside, &column);
    Load(y, begin, kOutside, &row);
    column += reach;
    row += reach;
    const LaneInts inside = (column >= zero) & (row >= zero) & (column < last) & (row < last);
    votes -= inside;  // which is -1 where it is true
    column = inside ? column : zero;
    row = inside ? row : zero;
    LaneCells at;
    FindCells(column, row, width, &at);
    const Lanes& fx = at.fx;
    const Lanes fy = inside ? at.fy : zero;
    const Lanes rest = inside ? 1.0f - fy : zero;  // what lies outside votes with nothing
    const Lanes w01 = fx * rest;
    const Lanes w00 = rest - w01;
    const Lanes w11 = fx * fy;
    const Lanes w10 = fy - w11;
    for (std::size_t i = 0; i < count; ++i) {
      vote(polarity[begin + i] < 0 ? second : 0, at.index[i], w00[i], w01[i], w10[i], w11[i]);
    }
  }
  std::int32_t all = 0;
  for (int i = 0; i < kLanes; ++i) all += votes[i];
  return all;
}

}  // namespace

void DensityMap::Vote(std::span<const float> x, std::span<const float> y, std::span<const std::int8_t> polarity) {
  total_ += VoteInto(cells_.data(), radius_, planes_ == 2 ? side() * side() : 0, x, y, polarity);
}

void DensityMap::Scale(float factor) {
  for (float& cell : cells_) cell *= factor;
  total_ *= static_cast<double>(factor);
}

void DensityMap::Blend(float keep, const DensityMap& other, float factor) {
  BlendCells(keep, other.cells_.data(), factor, cells_);
  total_ = static_cast<double>(keep) * total_ + static_cast<double>(factor) * other.total_;
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
  warped.total_ = std::accumulate(warped.cells_.begin(), warped.cells_.end(), 0.0);
  return warped;
}

namespace {

/// Smooths the planes of maps of one size with one Gaussian. Kept, with its memory, by each thread.
class Smoother {
 public:
  Smoother(int side, double sigma_px, AssociationField::Weight weight)
      : side_(side),
        kernel_(static_cast<std::size_t>(std::min(side / 2, GaussianReach(sigma_px))) + 1),
        margin_(static_cast<int>(kernel_.size())),
        width_((side + margin_ + kLanes - 1) / kLanes * kLanes),
        plane_(static_cast<std::size_t>((side + 2 * margin_) * width_)),
        rows_(plane_.size()),
        smooth_(plane_.size()),
        weights_(static_cast<std::size_t>(side * width_)) {
    FillGaussianKernel(sigma_px, kernel_);
    const int radius = side / 2;
    for (int r = 1; r + 1 < side; ++r) {
      for (int c = 1; c + 1 < side; ++c) {
        const double distance = std::hypot(r - radius, c - radius) / radius;
        const double by_distance = std::max(0.0, 1.0 - distance * distance);
        const double cell = weight == AssociationField::Weight::kEven ? 1.0 : by_distance * by_distance;
        weights_[static_cast<std::size_t>(r * width_ + c)] = static_cast<float>(cell);
      }
    }
  }

  static Smoother& Of(int side, double sigma_px, AssociationField::Weight weight) {
    thread_local std::map<std::tuple<int, double, AssociationField::Weight>, Smoother> smoothers;
    return smoothers.try_emplace({side, sigma_px, weight}, side, sigma_px, weight).first->second;
  }

  void Smooth(const float* plane) {
    // Rows run into one another, but only within the empty margin between them.
    for (int r = 0; r < side_; ++r) std::copy_n(plane + r * side_, side_, plane_.data() + (margin_ + r) * width_);
    const std::ptrdiff_t first = margin_ * width_;
    ConvolveCells(kernel_, plane_.data() + first, 1, side_ * width_, rows_.data() + first);
    ConvolveCells(kernel_, rows_.data() + first, width_, side_ * width_, smooth_.data() + first);
  }

  const float* smooth() const { return smooth_.data() + margin_ * width_; }
  const float* weights() const { return weights_.data(); }  ///< of each cell, in rows as wide
  int width() const { return width_; }

 private:
  int side_;
  std::vector<float> kernel_;
  int margin_;  // empty rows above and below the planes that follow, and cells at least between two rows
  int width_;   // of their rows
  std::vector<float> plane_, rows_, smooth_, weights_;
};

}  // namespace

void AssociationField::Build(const DensityMap& map, double sigma_px, double outlier_share, Weight weight) {
  const auto cells = static_cast<std::size_t>(map.planes() * map.side() * map.side());
  radius_ = map.radius();
  sigma_px_ = sigma_px;
  if (map.side() != side_ || table_.size() < cells) {
    side_ = map.side();
    // What is at the edge stays zero, and what is read or written beyond the last cell.
    table_.assign(cells + static_cast<std::size_t>(side_ + kLanes), Pull::Zero());
  }
  Smoother& smoother = Smoother::Of(side_, sigma_px, weight);
  const double mean_density = map.Total() / static_cast<double>(cells);
  const auto stray = static_cast<float>(std::max(1e-12, outlier_share * mean_density));
  const auto half_variance = static_cast<float>(0.5 * sigma_px * sigma_px);
  const auto longest = static_cast<float>(kLongestPull * sigma_px);
  for (int p = 0; p < map.planes(); ++p) {
    smoother.Smooth(map.plane(p));
    TabulatePulls(smoother.smooth(), smoother.weights(), smoother.width(), side_, stray, half_variance, longest,
                  table_[static_cast<std::size_t>(p * side_ * side_)].data());
  }
}

namespace {

/// The sums of vote x pull x (1, u, v) over the cells of a plane that lie in the patch.
struct VotedPulls {
  FourLanes one{}, u{}, v{};
};

/// Columns [begin, end) of a map, relative to its centre.
struct Columns {
  explicit Columns(int radius) : limit(radius + 1), begin(-radius), end(radius + 1) {}

  /// To those in which |a u + b| <= reach.
  EVO_INLINE void Restrict(float a, float b, float reach) {
    if (a == 0.0f) {
      if (std::abs(b) > reach) end = begin;
      return;
    }
    const float one = (reach - b) / a;
    const float other = (-reach - b) / a;
    const auto farthest = static_cast<float>(limit);
    // Positive numbers are rounded by cutting off.
    const int first = limit - static_cast<int>(farthest - std::clamp(std::min(one, other), -farthest, farthest));
    const int last = static_cast<int>(std::clamp(std::max(one, other), -farthest, farthest) + farthest) - limit;
    begin = std::max(begin, first);
    end = std::min(end, last + 1);
  }

  int limit;
  int begin, end;
};

EVO_HOT void AddMoments(const float* votes, const float* pulls, int radius, const Eigen::Matrix2f& linear, float reach,
                        VotedPulls* moments) {
  const int side = 2 * radius + 1;
  for (int r = 0; r < side; ++r) {
    const auto v = static_cast<float>(r - radius);
    Columns columns(radius);
    columns.Restrict(linear(0, 0), linear(0, 1) * v, reach);
    columns.Restrict(linear(1, 0), linear(1, 1) * v, reach);
    const int begin = r * side + radius + columns.begin;
    const int end = r * side + radius + columns.end;
    Lanes one{}, by_u{}, u = Lanes{} + static_cast<float>(columns.begin);
    u += Lanes{0, 0, 0, 0, 1, 1, 1, 1};
    for (int i = begin; i < end; i += 2) {
      Lanes pull, vote;
      Load(pulls + 4 * i, &pull);
      Join(FourLanes{} + votes[i], FourLanes{} + (i + 1 < end ? votes[i + 1] : 0.0f), &vote);
      pull *= vote;
      one += pull;
      by_u += u * pull;
      u += 2.0f;
    }
    FourLanes here, next, here_by_u, next_by_u;
    Split(one, &here, &next);
    Split(by_u, &here_by_u, &next_by_u);
    moments->one += here + next;
    moments->u += here_by_u + next_by_u;
    moments->v += v * (here + next);
  }
}

}  // namespace

PullMoments AssociationField::OwnMoments(const DensityMap& map, const Eigen::Matrix2d& linear,
                                         double patch_radius_px) const {
  VotedPulls m;
  for (int p = 0; p < map.planes(); ++p) {
    AddMoments(map.plane(p), table_[static_cast<std::size_t>(p * side_ * side_)].data(), radius_, linear.cast<float>(),
               static_cast<float>(patch_radius_px), &m);
  }
  if (!(m.one[0] > 0.0f)) return PullMoments::Zero();
  PullMoments moments;
  moments << m.one[1], m.u[1], m.v[1], m.one[2], m.u[2], m.v[2];
  return moments / m.one[0];
}

Eigen::Matrix2d AssociationField::Information(const DensityMap& map, const AssociationField& other) const {
  Eigen::Array4f sum = Eigen::Array4f::Zero();  // xx, xy, yx, yy
  float weight = 0.0f;
  const float* votes = map.plane(0);
  for (int i = 0; i < map.planes() * side_ * side_; ++i) {
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

}  // namespace evo::tracking
