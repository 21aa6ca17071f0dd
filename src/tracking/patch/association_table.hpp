#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "evo/core/bilinear.hpp"
#include "tracking/patch/event_histogram.hpp"

namespace evo::tracking {

/// The mean shift that a template's own events feel, as sums of shift x (1, u, v): row 0 along x, row 1 along y; px.
using SelfBias = Eigen::Matrix<double, 2, 3>;

/// The E step of the tracker, tabulated: the soft association of an event with the events of a template (A. Z. Zhu et
/// al.: Event-based Feature Tracking with Probabilistic Data Association, ICRA 2017, equations 6 to 9). With template
/// events p_j of density D(u) = sum_j N(u; p_j, sigma^2), an event at u has its expected partner at
/// u + sigma^2 grad D / D (the mean shift; D. Comaniciu, P. Meer, PAMI 2002) and is an inlier with probability
/// D / (D + D0), where D0 is the density of outliers. A look-up costs some nanoseconds; the paper's sum over all pairs
/// of events costs microseconds.
class AssociationTable {
 public:
  /// One cell: the inlier probability; the inlier probability times the mean shift in x and in y (px); 1. All four are
  /// multiplied by the cell's weight.
  using Association = Eigen::Array4f;

  enum class Weighting {
    kBiweight,  ///< (1 - r^2)^2, from 1 at the centre to 0 at the radius: far cells more often have another depth
    kUniform,
  };
  /// `outlier_density_ratio`: D0 over the histogram's mean density. `sigma_px` is in cells of the histogram.
  void Build(const EventHistogram& histogram, double sigma_px, double outlier_density_ratio,
             Weighting weighting = Weighting::kBiweight);

  int radius() const { return radius_; }
  int side() const { return side_; }
  /// Logarithm of the density, over that of the outliers alone, of events that are spread evenly over a plane.
  float log_even_density(int plane) const { return log_even_densities_[static_cast<std::size_t>(plane)]; }
  /// All cells, row by row and plane by plane. Zero at the edge of a plane, and for more than a row after the last.
  const Association* cells() const { return cells_.data(); }
  /// The association of an event at (x, y); zero outside.
  Association Interpolate(float x, float y, int plane) const {
    const float column = x + static_cast<float>(radius_);
    const float row = y + static_cast<float>(radius_);
    const auto last = static_cast<float>(side_ - 1);
    if (!(column >= 0.0f && row >= 0.0f && column < last && row < last)) return Association::Zero();
    const BilinearCell<float> at(column, row);
    const Association* upper = cells_.data() + (plane * side_ + at.row) * side_ + at.column;
    return InterpolateBilinear(at, upper, upper + side_);
  }

  /// The self bias of the histogram's events, per unit of their weight. A blurred density shifts even perfectly aligned
  /// events inwards, so an alignment subtracts this bias. Counts the events at u with linear * u inside a square patch
  /// of `patch_radius_px`.
  SelfBias ComputeSelfBias(const EventHistogram& histogram, const Eigen::Matrix2d& linear,
                           double patch_radius_px) const;

  /// Information of one event of the histogram on the position of its pattern, 1/px^2, as far as this density D and the
  /// other density D' agree: the mean of grad D grad D'^T / (D D'); for D' = D it is the Fisher information. Small
  /// along a direction in which the pattern may slide (the aperture problem), where the pattern is blurred, and where
  /// the densities of two sets of events differ.
  Eigen::Matrix2d Information(const EventHistogram& histogram, const AssociationTable& other) const;

 private:
  int radius_ = 0;
  int side_ = 0;
  double sigma_px_ = 1.0;
  std::array<float, 2> log_even_densities_{};
  std::vector<Association> cells_;
};

}  // namespace evo::tracking
