#include "tracking/patch/event_histogram.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "tracking/patch/simd8.hpp"

namespace evo::tracking {

namespace {

EVO_HOT void BlendCells(float keep, const float* other, float factor, std::span<float> cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = keep * cells[i] + factor * other[i];
}

/// Adds the events to `cells`, those of negative polarity `negative_offset` cells further. Returns how many events lie
/// inside.
EVO_HOT std::int32_t AddVotes(float* cells, int radius, std::int32_t negative_offset, std::span<const float> x,
                              std::span<const float> y, std::span<const std::int8_t> polarity) {
  const std::ptrdiff_t side = 2 * radius + 1;
  const auto centre = static_cast<float>(radius);
  const auto width = static_cast<float>(side);
  const F32x8 zero{};
  const F32x8 last = zero + static_cast<float>(2 * radius);
  I32x8 votes{};
  const auto vote = [&](std::int32_t plane, std::int32_t cell, float w00, float w01, float w10, float w11) {
    float* const at = cells + plane + cell;
    at[0] += w00;
    at[1] += w01;
    at[side] += w10;
    at[side + 1] += w11;
  };
  for (std::size_t begin = 0; begin < x.size(); begin += kLanes) {
    const std::size_t count = std::min<std::size_t>(kLanes, x.size() - begin);
    F32x8 column, row;
    Load(x, begin, kOutsidePx, &column);
    Load(y, begin, kOutsidePx, &row);
    column += centre;
    row += centre;
    const I32x8 inside = (column >= zero) & (row >= zero) & (column < last) & (row < last);
    votes -= inside;  // true is -1
    column = inside ? column : zero;
    row = inside ? row : zero;
    Cells8 at;
    FindCells(column, row, width, &at);
    const F32x8& fx = at.fx;
    const F32x8 fy = inside ? at.fy : zero;
    const F32x8 rest = inside ? 1.0f - fy : zero;  // an event outside has no weight
    const F32x8 w01 = fx * rest;
    const F32x8 w00 = rest - w01;
    const F32x8 w11 = fx * fy;
    const F32x8 w10 = fy - w11;
    for (std::size_t i = 0; i < count; ++i) {
      vote(polarity[begin + i] < 0 ? negative_offset : 0, at.index[i], w00[i], w01[i], w10[i], w11[i]);
    }
  }
  std::int32_t all = 0;
  for (int i = 0; i < kLanes; ++i) all += votes[i];
  return all;
}

/// The point that a warp moves to `target`; empty beyond the horizon of its plane.
std::optional<Eigen::Vector2f> Unwarp(const Eigen::Matrix2f& inverse, const Eigen::Vector2f& perspective,
                                      const Eigen::Vector2f& target) {
  const Eigen::Vector2f affine = inverse * target;
  const float depth = 1.0f - perspective.dot(affine);  // of the centre over that of the point
  if (!(depth > 0.0f)) return std::nullopt;
  return affine / depth;
}

/// Bilinear density at a place of a plane, in cells; zero outside. Not InterpolateBilinear, whose rounding differs.
float SampleDensity(const float* plane, int side, float column, float row) {
  const auto last = static_cast<float>(side - 1);
  if (!(column >= 0.0f && row >= 0.0f && column < last && row < last)) return 0.0f;
  const BilinearCell<float> at(column, row);
  const float* cell = plane + at.row * side + at.column;
  return (1.0f - at.fy) * ((1.0f - at.fx) * cell[0] + at.fx * cell[1]) +
         at.fy * ((1.0f - at.fx) * cell[side] + at.fx * cell[side + 1]);
}

}  // namespace

EventHistogram::EventHistogram(int radius_px, int planes)
    : radius_(radius_px), planes_(planes), cells_(static_cast<std::size_t>(planes * side() * side()), 0.0f) {}

double EventHistogram::EffectiveCells() const {
  const double squares = std::inner_product(cells_.begin(), cells_.end(), cells_.begin(), 0.0);
  return squares > 0.0 ? total_ * total_ / squares : 0.0;
}

void EventHistogram::Clear() {
  std::ranges::fill(cells_, 0.0f);
  total_ = 0.0;
}

void EventHistogram::Vote(std::span<const float> x, std::span<const float> y, std::span<const std::int8_t> polarity) {
  total_ += AddVotes(cells_.data(), radius_, planes_ == 2 ? side() * side() : 0, x, y, polarity);
}

void EventHistogram::Scale(float factor) {
  for (float& cell : cells_) cell *= factor;
  total_ *= static_cast<double>(factor);
}

void EventHistogram::Blend(float keep, const EventHistogram& other, float factor) {
  BlendCells(keep, other.cells_.data(), factor, cells_);
  total_ = static_cast<double>(keep) * total_ + static_cast<double>(factor) * other.total_;
}

void EventHistogram::ExchangePlanes(std::span<const float> ratios) {
  if (planes_ != 2) return;
  float* const one = cells_.data();
  float* const two = one + side() * side();
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    const float moved = ratios[i] * (two[i] - one[i]);
    one[i] += moved;
    two[i] -= moved;
  }
}

EventHistogram EventHistogram::Warped(const Eigen::Matrix2d& linear, const Eigen::Vector2d& perspective) const {
  EventHistogram warped(radius_, planes_);
  const Eigen::Matrix2f inverse = linear.inverse().cast<float>();
  const Eigen::Vector2f perspective_f = perspective.cast<float>();
  const auto density = static_cast<float>(1.0 / std::abs(linear.determinant()));  // old cells per new cell
  const auto centre = static_cast<float>(radius_);
  float* target = warped.cells_.data();
  for (int p = 0; p < planes_; ++p) {
    for (int r = 0; r < side(); ++r) {
      for (int c = 0; c < side(); ++c, ++target) {
        const auto u = Unwarp(inverse, perspective_f, {static_cast<float>(c) - centre, static_cast<float>(r) - centre});
        if (!u) continue;
        const float sample = SampleDensity(plane(p), side(), u->x() + centre, u->y() + centre);
        if (sample > 0.0f) *target = density * sample;
      }
    }
  }
  warped.total_ = std::accumulate(warped.cells_.begin(), warped.cells_.end(), 0.0);
  return warped;
}

}  // namespace evo::tracking
