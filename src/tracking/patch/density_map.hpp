#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace evo::tracking {

/// How many events fell where around a feature: a square histogram of 1 px cells centred on (0, 0), one plane for each
/// polarity (or one for both).
class DensityMap {
 public:
  DensityMap(int radius_px, int planes);

  int radius() const { return radius_; }
  int side() const { return 2 * radius_ + 1; }
  int planes() const { return planes_; }
  int PlaneOf(std::int8_t polarity) const { return planes_ == 2 && polarity < 0 ? 1 : 0; }
  const float* plane(int p) const { return cells_.data() + p * side() * side(); }
  double Total() const { return total_; }
  /// Number of cells that the events would fill if they were spread evenly: (sum n)^2 / sum n^2.
  double EffectiveCells() const;

  void Clear();
  void Scale(float factor);
  /// Becomes `keep` times itself and `factor` times another map of the same size.
  void Blend(float keep, const DensityMap& other, float factor);
  /// Adds an event bilinearly to the four cells around it; nothing happens outside the map.
  void Vote(float x, float y, int plane, float weight) {
    const float column = x + static_cast<float>(radius_);
    const float row = y + static_cast<float>(radius_);
    const auto last = static_cast<float>(side() - 1);
    if (!(column >= 0.0f && row >= 0.0f && column < last && row < last)) return;
    const int c = static_cast<int>(column);
    const int r = static_cast<int>(row);
    const float fx = column - static_cast<float>(c);
    const float fy = row - static_cast<float>(r);
    total_ += weight;
    float* cell = cells_.data() + (plane * side() + r) * side() + c;
    cell[0] += weight * (1.0f - fx) * (1.0f - fy);
    cell[1] += weight * fx * (1.0f - fy);
    cell[side()] += weight * (1.0f - fx) * fy;
    cell[side() + 1] += weight * fx * fy;
  }
  /// The same for many events, each of weight 1.
  void Vote(std::span<const float> x, std::span<const float> y, std::span<const std::int8_t> polarity);
  /// The same events seen in other coordinates: a cell at u moves to `linear` * u / (1 + `perspective` . u).
  DensityMap Warped(const Eigen::Matrix2d& linear, const Eigen::Vector2d& perspective = Eigen::Vector2d::Zero()) const;

 private:
  int radius_;
  int planes_;
  std::vector<float> cells_;
  double total_ = 0.0;
};

/// The sums of pull x (1, u, v): row 0 for the pull along x, row 1 along y.
using PullMoments = Eigen::Matrix<double, 2, 3>;

/// The E step of expectation maximisation with Gaussian soft association, tabulated. For an event at u and template
/// events p_j with density D(u) = sum_j N(u; p_j, sigma^2), the expected partner lies at u + sigma^2 grad D / D (the
/// mean shift) and the event is one of the template's, not a stray one, with probability D / (D + D0). Looking both up
/// costs some nanoseconds; summing over all pairs costs microseconds (Zhu et al., equations 6 to 9, do the latter).
class AssociationField {
 public:
  /// What an event at some place is pulled by: its probability of not being stray; that times the way to the expected
  /// partner in x and in y (px); one. All four times a weight that falls from 1 at the centre to 0 at the map's radius,
  /// (1 - r^2)^2: what lies farther out is more often of another depth, and bends more.
  using Pull = Eigen::Array4f;

  enum class Weight { kCentre, kEven };
  /// `outlier_share`: D0 as a share of the map's mean density.
  void Build(const DensityMap& map, double sigma_px, double outlier_share, Weight weight = Weight::kCentre);

  int radius() const { return radius_; }
  int side() const { return side_; }
  /// Of all cells, row by row and plane by plane. Zero at the edge of a plane, and for more than a row after the last.
  const Pull* table() const { return table_.data(); }
  Pull At(float x, float y, int plane) const {
    const float column = x + static_cast<float>(radius_);
    const float row = y + static_cast<float>(radius_);
    const auto last = static_cast<float>(side_ - 1);
    if (!(column >= 0.0f && row >= 0.0f && column < last && row < last)) return Pull::Zero();
    const int c = static_cast<int>(column);
    const int r = static_cast<int>(row);
    const float fx = column - static_cast<float>(c);
    const float fy = row - static_cast<float>(r);
    const Pull* cell = table_.data() + (plane * side_ + r) * side_ + c;
    const Pull above = cell[0] + fx * (cell[1] - cell[0]);
    const Pull below = cell[side_] + fx * (cell[side_ + 1] - cell[side_]);
    return above + fy * (below - above);
  }

  /// What the map's own events feel, per unit of their weight. It is not zero (a blurred density pulls inwards), and is
  /// what a perfectly aligned window would feel too. Such a window sees the events at u with linear * u inside a
  /// square patch of `patch_radius_px`.
  PullMoments OwnMoments(const DensityMap& map, const Eigen::Matrix2d& linear, double patch_radius_px) const;

  /// What one event of the map tells about where the pattern is, 1/px^2, as far as this density and the other one
  /// agree: the mean of grad D grad D'^T / (D D'), of one density with itself its Fisher information. Small along a
  /// direction in which the pattern may slide (the aperture problem), where it is blurred, and where the densities of
  /// two sets of events differ.
  Eigen::Matrix2d Information(const DensityMap& map, const AssociationField& other) const;

 private:
  int radius_ = 0;
  int side_ = 0;
  double sigma_px_ = 1.0;
  std::vector<Pull> table_;  // per plane and cell
};

}  // namespace evo::tracking
