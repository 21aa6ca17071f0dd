#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

namespace evo {

/// The Gaussian density of a few hundred events around (0, 0), and the mean shift in it: what AssociationField
/// tabulates for many look-ups, computed only where the events are. One plane for each polarity, or one for both.
class EventDensity {
 public:
  /// All lengths in cells. Events farther out than `radius` in x or in y are left out.
  EventDensity(int radius, int planes, double sigma);

  void Clear();
  /// Adds an event bilinearly to the four cells around it.
  void Vote(float x, float y, int plane) {
    const Place at = Find(x, y, plane);
    if (!at.inside) return;
    float* const cell = votes_.data() + at.cell;
    cell[0] += (1.0f - at.fx) * (1.0f - at.fy);
    cell[1] += at.fx * (1.0f - at.fy);
    cell[stride_] += (1.0f - at.fx) * at.fy;
    cell[stride_ + 1] += at.fx * at.fy;
    ++events_;
  }
  /// Smooths the votes. Stray events have `outlier_share` of the mean density.
  void Smooth(double outlier_share);

  /// What pulls an event: its probability of not being stray, and that times the way to its expected partner.
  struct Pull {
    float weight = 0.0f, x = 0.0f, y = 0.0f;
  };
  Pull At(float x, float y, int plane) const {
    const Place at = Find(x, y, plane);
    if (!at.inside) return {};
    using Four = Eigen::Array4f;  // columns -1 to 2 around the event
    using Row = Eigen::Map<const Four>;
    const float* const row = smooth_.data() + at.cell - 1;
    const Row before(row - stride_), above(row), below(row + stride_), after(row + 2 * stride_);
    const Four down = below - above;
    const Four density = above + at.fy * down;
    const Four slope = (below - before) + at.fy * (after - above - (below - before));
    const float x_slope = density[2] - density[0] + at.fx * (density[3] - density[1] - (density[2] - density[0]));
    return FromDensity(density[1] + at.fx * (density[2] - density[1]), x_slope,
                       slope[1] + at.fx * (slope[2] - slope[1]));
  }

 private:
  // Where the density is nearly flat and nearly nothing the mean shift is unreliable: limit it to so much.
  static constexpr double kLongestPullSigmas = 2.5;

  struct Place {
    bool inside;
    float fx, fy;
    std::ptrdiff_t cell;
  };

  Place Find(float x, float y, int plane) const {
    const float column = x + static_cast<float>(radius_);
    const float row = y + static_cast<float>(radius_);
    const auto last = static_cast<float>(2 * radius_);
    if (!(column >= 0.0f && row >= 0.0f && column < last && row < last)) return {false, 0.0f, 0.0f, 0};
    const int c = static_cast<int>(column);
    const int r = static_cast<int>(row);
    return {true, column - static_cast<float>(c), row - static_cast<float>(r),
            plane * plane_cells_ + (r + margin_) * stride_ + c + margin_};
  }

  /// The mean shift variance * gradient / density, times the probability density / (density + stray).
  Pull FromDensity(float density, float x_slope, float y_slope) const {
    const float share = 1.0f / (density + stray_);
    const float weight = density * share;
    const float limit = longest_pull_ * weight;
    return {weight, std::clamp(half_variance_ * share * x_slope, -limit, limit),
            std::clamp(half_variance_ * share * y_slope, -limit, limit)};
  }
  /// `out` = the cells of `in` weighted by the kernel along a line of cells that are `step` apart.
  void Convolve(const std::vector<float>& in, std::ptrdiff_t step, std::vector<float>* out) const;

  int radius_;
  int planes_;
  float half_variance_;
  float longest_pull_;
  std::vector<float> kernel_;  // [|distance|]
  std::ptrdiff_t margin_;      // empty cells around a plane
  std::ptrdiff_t stride_;      // from row to row
  std::ptrdiff_t plane_cells_;
  std::vector<float> votes_, rows_, smooth_;
  float stray_ = 0.0f;
  int events_ = 0;
};

}  // namespace evo
