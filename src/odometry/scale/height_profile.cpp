#include "odometry/scale/height_profile.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "evo/core/median.hpp"
#include "evo/core/robust.hpp"
#include "odometry/scale/random_walk_smoother.hpp"

namespace evo::odometry {

namespace {

constexpr double kKernelWidth = 0.05;      // of the density of the heights' logarithms: twice a flat road's scatter
constexpr double kKernelStep = 0.02;       // between the heights that are tried
constexpr double kKernelReach = 3.0;       // widths
constexpr double kMaxRelativeSigma = 0.1;  // a track less certain than this says nothing of the height
constexpr double kRoughness = 0.01;        // of the ground, in heights
constexpr double kRollSigma = 0.05;        // rad, prior
constexpr double kBreakSigma = 0.3;        // relative change of the scale where it was lost
constexpr double kMadToSigma = 1.4826;     // median absolute deviation of a Gaussian to its standard deviation
// The noise factor of tracks on the ground is near 1, that of other structure is larger.
constexpr double kMinNoiseFactor = 0.1;
constexpr double kMaxNoiseFactor = 2.0;
// Relative distances from the profile within which observations take part, from coarse to fine; at 0 their noise
// decides.
constexpr std::array kGates = {0.3, 0.2, 0.15, 0.1, 0.07, 0.05, 0.03, 0.0, 0.0, 0.0};
constexpr double kNoiseGateSigmas = 3.0;
constexpr double kMaxNodes = 1e5;  // bounds memory for whatever height outliers suggest
constexpr std::size_t kMinTracks = 20;
constexpr std::size_t kSectionNodes = 10;      // nodes (heights of arc length) on which most observations have to agree
constexpr double kMinAgreeingInSection = 0.5;  // ratio of its observations
constexpr double kMinAgreeingSections = 0.9;   // ratio, by their number of observations
constexpr double kCoveredSigma = 0.01;         // relative, where the height counts as known

/// The mode of the observations' inverse heights: the maximum of a kernel density over their logarithms, weighted by
/// their certainty; 0 without any.
double FindModeOfInverseHeights(const std::vector<GroundObservation>& observations) {
  struct Kernel {
    double log_height;
    double weight;
  };
  std::vector<Kernel> kernels;
  for (const auto& observation : observations) {
    const double sigma = observation.sigma / observation.inverse_height;
    kernels.push_back({std::log(observation.inverse_height), 1.0 / (sigma * sigma + kKernelWidth * kKernelWidth)});
  }
  if (kernels.empty()) return 0.0;
  std::ranges::sort(kernels, {}, &Kernel::log_height);
  const double min = kernels.front().log_height;
  Kernel mode{0.0, 0.0};
  std::size_t begin = 0;
  const int steps = static_cast<int>((kernels.back().log_height - min) / kKernelStep) + 1;
  for (int step = 0; step <= steps; ++step) {
    const double center = min + kKernelStep * step;
    while (begin < kernels.size() && kernels[begin].log_height < center - kKernelReach * kKernelWidth) ++begin;
    double density = 0.0;
    for (std::size_t i = begin; i < kernels.size(); ++i) {
      if (!(kernels[i].log_height < center + kKernelReach * kKernelWidth)) break;
      const double u = (kernels[i].log_height - center) / kKernelWidth;
      density += kernels[i].weight * std::exp(-0.5 * u * u);
    }
    if (density > mode.weight) mode = {center, density};
  }
  return std::exp(mode.log_height);
}

/// A place between two nodes.
struct NodeFraction {
  std::size_t node;
  double fraction;  // of the way to the next node
};

NodeFraction Locate(const HeightProfile& profile, double arc_length) {
  const std::size_t last = profile.inverse_heights.size() - 1;
  const double position = std::clamp(arc_length / profile.spacing, 0.0, static_cast<double>(last));
  const std::size_t node = std::min(static_cast<std::size_t>(position), last - 1);
  return {node, position - static_cast<double>(node)};
}

class HeightProfileFitter {
 public:
  HeightProfileFitter(const HeightProfileOptions& options, const std::vector<GroundObservation>& observations)
      : options_(options), observations_(observations) {
    std::erase_if(observations_, [](const auto& o) { return !(o.sigma < kMaxRelativeSigma * o.inverse_height); });
  }

  std::optional<HeightProfile> Fit() {
    if (observations_.size() < kMinTracks) return std::nullopt;
    Initialize();
    for (const double gate : kGates) {
      EstimateNoiseFactor(gate);
      if (!Iterate(gate)) return std::nullopt;
    }
    spdlog::debug("odometry: {} of {} tracks below the path lie on the ground, noise factor {:.2f}, roll {:.4f} rad",
                  profile_.quality.inliers, observations_.size(), noise_factor_, profile_.roll);
    if (noise_factor_ >= kMaxNoiseFactor || AgreeingRatio() < kMinAgreeingSections) return std::nullopt;
    Summarize();
    return profile_;
  }

 private:
  /// Every part between breaks starts at the mode of its heights.
  void Initialize() {
    const double mode = FindModeOfInverseHeights(observations_);
    profile_.spacing = std::max(1.0 / mode, options_.path_length / kMaxNodes);
    profile_.inverse_heights.assign(static_cast<std::size_t>(options_.path_length / profile_.spacing) + 2, mode);
    break_after_.assign(profile_.inverse_heights.size(), false);
    for (const double arc_length : options_.scale_breaks) break_after_[Locate(profile_, arc_length).node] = true;
    std::vector<std::vector<GroundObservation>> node_observations(break_after_.size());
    for (const auto& o : observations_) node_observations[Locate(profile_, o.arc_length).node].push_back(o);
    std::vector<GroundObservation> part;
    for (std::size_t begin = 0, k = 0; k < break_after_.size(); ++k) {
      part.insert(part.end(), node_observations[k].begin(), node_observations[k].end());
      if (!break_after_[k] && k + 1 < break_after_.size()) continue;
      const double part_mode = part.size() < kMinTracks ? mode : FindModeOfInverseHeights(part);
      for (; begin <= k; ++begin) profile_.inverse_heights[begin] = part_mode;
      part.clear();
    }
  }

  struct Residual {
    double error;  // relative
    double sigma;  // relative, with the estimated noise factor
  };
  Residual Compare(const GroundObservation& o) const {
    const double x = profile_.InverseHeight(o.arc_length);
    return {o.inverse_height / x - (1.0 - profile_.roll * o.lateral_ratio),
            std::hypot(noise_factor_ * o.sigma / x, kRoughness)};
  }

  /// The factor common to the observations' standard deviations.
  void EstimateNoiseFactor(double gate) {
    std::vector<double> ratios;
    for (const auto& o : observations_) {
      const auto [error, sigma] = Compare(o);
      if (std::abs(error) > std::max(gate, kNoiseGateSigmas * sigma)) continue;
      ratios.push_back(std::abs(error) * profile_.InverseHeight(o.arc_length) / o.sigma);
    }
    noise_factor_ = std::clamp(kMadToSigma * Median(ratios), kMinNoiseFactor, kMaxNoiseFactor);
  }

  /// One iteration of reweighted least squares for the heights and the roll; false if too few observations agree.
  bool Iterate(double gate) {
    RandomWalkSmoother smoother(profile_.inverse_heights.size());
    double roll_weight = 1.0 / (kRollSigma * kRollSigma);
    double roll_right_side = 0.0;
    std::size_t inliers = 0;
    for (const auto& o : observations_) {
      const auto [error, sigma] = Compare(o);
      const double u = error / std::max(gate, kTukeyWidth * sigma);
      if (std::abs(u) >= 1.0) continue;
      ++inliers;
      const double weight = std::pow((1.0 - u * u) / sigma, 2);  // Tukey's, over the variance
      const auto [node, fraction] = Locate(profile_, o.arc_length);
      const double x = profile_.InverseHeight(o.arc_length);
      smoother.AddObservation(node, fraction, 1.0 - profile_.roll * o.lateral_ratio, o.inverse_height,
                              weight / (x * x));
      roll_weight += weight * o.lateral_ratio * o.lateral_ratio;
      roll_right_side += weight * o.lateral_ratio * (1.0 - o.inverse_height / x);
    }
    profile_.quality.inliers = inliers;
    if (inliers < kMinTracks) return false;
    for (std::size_t k = 0; k + 1 < break_after_.size(); ++k) {
      const double heights = profile_.spacing * profile_.inverse_heights[k];
      const double relative_sigma = break_after_[k] ? kBreakSigma : options_.scale_drift_ratio * std::sqrt(heights);
      const double sigma = relative_sigma * profile_.inverse_heights[k];
      smoother.AddStep(k, 1.0 / (sigma * sigma));
    }
    auto solution = smoother.Solve();
    profile_.inverse_heights = std::move(solution.values);
    variances_ = std::move(solution.variances);
    profile_.roll = roll_right_side / roll_weight;
    return true;
  }

  /// Ratio of the sections in which most observations agree with the profile, by their number of observations.
  double AgreeingRatio() const {
    std::vector<std::size_t> all(profile_.inverse_heights.size() / kSectionNodes + 1);
    std::vector<std::size_t> agreeing(all.size());
    for (const auto& o : observations_) {
      const auto [error, sigma] = Compare(o);
      const std::size_t k = Locate(profile_, o.arc_length).node / kSectionNodes;
      ++all[k];
      if (std::abs(error) < kTukeyWidth * sigma) ++agreeing[k];
    }
    std::size_t in_agreement = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const bool agrees = static_cast<double>(agreeing[k]) >= kMinAgreeingInSection * static_cast<double>(all[k]);
      if (agrees) in_agreement += all[k];
    }
    return static_cast<double>(in_agreement) / static_cast<double>(observations_.size());
  }

  void Summarize() {
    profile_.path_length_in_heights = options_.path_length / profile_.spacing;
    std::vector<double> sigmas;
    for (std::size_t k = 0; k < variances_.size(); ++k) {
      sigmas.push_back(std::sqrt(variances_[k]) / profile_.inverse_heights[k]);
    }
    const auto covered = std::ranges::count_if(sigmas, [](double sigma) { return sigma < kCoveredSigma; });
    profile_.quality.covered_ratio = static_cast<double>(covered) / static_cast<double>(sigmas.size());
    profile_.quality.relative_sigma = Median(std::move(sigmas));
  }

  const HeightProfileOptions& options_;
  std::vector<GroundObservation> observations_;
  HeightProfile profile_;
  std::vector<bool> break_after_;  // the scale was lost between each node and the next
  std::vector<double> variances_;  // of the nodes' inverse heights
  double noise_factor_ = 1.0;
};

}  // namespace

double HeightProfile::InverseHeight(double arc_length) const {
  const auto [node, fraction] = Locate(*this, arc_length);
  return (1.0 - fraction) * inverse_heights[node] + fraction * inverse_heights[node + 1];
}

std::optional<HeightProfile> FitHeightProfile(const HeightProfileOptions& options,
                                              const std::vector<GroundObservation>& observations) {
  return HeightProfileFitter(options, observations).Fit();
}

}  // namespace evo::odometry
