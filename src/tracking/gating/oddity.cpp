#include "tracking/gating/oddity.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "evo/core/median.hpp"

namespace evo::tracking {

namespace {

constexpr std::size_t kRemembered = 200;
constexpr std::size_t kFewest = 50;
constexpr double kSmallestSize = 1e-9;  // that is usual

}  // namespace

void OddityMeans::Add(const Eigen::Vector2d& offset, const Eigen::Matrix2d& rate, double stray_share) {
  const double gain = 1.0 / ++frames_;
  offset_ += gain * (offset - offset_);
  rate_ += gain * (rate - rate_);
  stray_share_ += gain * (stray_share - stray_share_);
}

Oddity OddityMeans::Of(const Eigen::Vector2d& away) const {
  const Eigen::Vector2d along = away.normalized();
  return {{std::abs(along.x() * offset_.y() - along.y() * offset_.x()), rate_.norm(), stray_share_}};
}

std::vector<bool> OddityJudge::AreOdd(const std::vector<Oddity>& young) {
  last_.insert(last_.end(), young.begin(), young.end());
  while (last_.size() > std::max(kRemembered, young.size())) last_.pop_front();
  std::vector<bool> are_odd(young.size(), false);
  const auto odd = static_cast<std::ptrdiff_t>(odd_share_ * static_cast<double>(last_.size()));
  if (young.empty() || last_.size() < kFewest || odd == 0) return are_odd;

  std::array<double, 3> usual{};
  for (std::size_t k = 0; k < usual.size(); ++k) {
    std::vector<double> sizes;
    for (const auto& oddity : last_) sizes.push_back(oddity.sizes[k]);
    usual[k] = std::max(Median(sizes), kSmallestSize);
  }
  std::vector<double> sums;
  for (const auto& oddity : last_) {
    double sum = 0.0;
    for (std::size_t k = 0; k < usual.size(); ++k) sum += std::log1p(oddity.sizes[k] / usual[k]);
    sums.push_back(sum);
  }
  const std::vector<double> of_young(sums.end() - static_cast<std::ptrdiff_t>(young.size()), sums.end());
  const auto least = sums.end() - odd;
  std::ranges::nth_element(sums, least);
  for (std::size_t i = 0; i < young.size(); ++i) are_odd[i] = of_young[i] >= *least;
  return are_odd;
}

}  // namespace evo::tracking
