#include "tracking/gating/outlier_classifier.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "evo/core/median.hpp"

namespace evo::tracking {

namespace {

constexpr std::size_t kMaxRecent = 200;        // features to compare with: enough for a quantile of a few percent
constexpr std::size_t kMinRecent = 50;         // with fewer, the medians and the quantile are noise
constexpr double kMinTypicalComponent = 1e-9;  // guards the division if a component is always zero

OutlierScore TypicalScore(const std::deque<OutlierScore>& scores) {
  OutlierScore typical;
  for (std::size_t k = 0; k < typical.components.size(); ++k) {
    std::vector<double> components;
    for (const auto& score : scores) components.push_back(score.components[k]);
    typical.components[k] = std::max(Median(components), kMinTypicalComponent);
  }
  return typical;
}

double LogSum(const OutlierScore& score, const OutlierScore& typical) {
  double sum = 0.0;
  for (std::size_t k = 0; k < typical.components.size(); ++k) {
    sum += std::log1p(score.components[k] / typical.components[k]);
  }
  return sum;
}

}  // namespace

std::vector<bool> OutlierClassifier::Classify(const std::vector<OutlierScore>& young) {
  recent_.insert(recent_.end(), young.begin(), young.end());
  while (recent_.size() > std::max(kMaxRecent, young.size())) recent_.pop_front();
  std::vector<bool> are_outliers(young.size(), false);
  const auto outliers = static_cast<std::ptrdiff_t>(rejection_ratio_ * static_cast<double>(recent_.size()));
  if (young.empty() || recent_.size() < kMinRecent || outliers == 0) return are_outliers;

  const OutlierScore typical = TypicalScore(recent_);
  std::vector<double> sums;
  for (const auto& score : recent_) sums.push_back(LogSum(score, typical));
  const std::vector<double> young_sums(sums.end() - static_cast<std::ptrdiff_t>(young.size()), sums.end());
  const auto threshold = sums.end() - outliers;
  std::ranges::nth_element(sums, threshold);
  for (std::size_t i = 0; i < young.size(); ++i) are_outliers[i] = young_sums[i] >= *threshold;
  return are_outliers;
}

}  // namespace evo::tracking
