#pragma once

#include <deque>
#include <vector>

#include "tracking/gating/outlier_evidence.hpp"

namespace evo::tracking {

/// Compares young features with those classified before. The score of a feature sums log(1 + c / median of c) over the
/// components c of its OutlierScore, so it is high if all of them are unusual together. The features with the highest
/// scores are outliers.
class OutlierClassifier {
 public:
  /// `rejection_ratio`: ratio of outliers to all features.
  explicit OutlierClassifier(double rejection_ratio) : rejection_ratio_(rejection_ratio) {}

  /// Whether each of the `young` features is among the `rejection_ratio` with the highest scores, out of the last
  /// features and these. None is while there are too few to compare with.
  std::vector<bool> Classify(const std::vector<OutlierScore>& young);

 private:
  double rejection_ratio_;
  std::deque<OutlierScore> recent_;
};

}  // namespace evo::tracking
