#include "odometry/scale/height_profile.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "evo/core/median.hpp"
#include "odometry/scale/ground_search.hpp"
#include "odometry/scale/plane_smoother.hpp"

namespace evo::odometry {

namespace {

constexpr double kMaxRelativeSigma = 0.1;  // a track less certain than this says nothing of the height
constexpr double kRoughness = 0.01;        // of the ground, in heights
// Relative error of the height that all tracks within an arc of one height have in common: a car rocks on its springs.
constexpr double kRocking = 0.005;
constexpr double kRollSigma = 0.05;     // rad, prior
constexpr double kBreakSigma = 0.3;     // relative change of the scale where it was lost
constexpr double kMadToSigma = 1.4826;  // median absolute deviation of a Gaussian to its standard deviation
// The noise factor of tracks on the ground is near 1, that of other structure is larger.
constexpr double kMinNoiseFactor = 0.1;
constexpr double kMaxNoiseFactor = 2.0;
constexpr int kIterations = 10;
constexpr double kMaxNodes = 1e5;  // bounds memory for whatever height outliers suggest
constexpr std::size_t kMinTracks = 20;
constexpr std::size_t kSectionNodes = 5;  // nodes (heights of arc length) to a section of the search
constexpr double kMinEvidence = 10.0;     // without a ground, the best of all heights and rolls reaches about 4
constexpr double kMinSeenRatio = 0.5;     // of the path, in sections with tracks on the ground
// Beyond it the height is not constant; bumps and a car that rocks on its springs make up to 0.01.
constexpr double kMaxCommonSigma = 0.015;
constexpr double kCoveredSigma = 0.01;  // relative, where the height counts as known

/// A place between two nodes.
struct NodeFraction {
  std::size_t node;
  double fraction;  // of the way to the next node
};

NodeFraction Locate(double spacing, std::size_t nodes, double arc_length) {
  const double position = std::clamp(arc_length / spacing, 0.0, static_cast<double>(nodes - 1));
  const std::size_t node = std::min(static_cast<std::size_t>(position), nodes - 2);
  return {node, position - static_cast<double>(node)};
}

double MedianInverseHeight(const std::vector<GroundObservation>& observations) {
  std::vector<double> inverse_heights;
  for (const auto& o : observations) inverse_heights.push_back(o.inverse_height);
  return Median(std::move(inverse_heights));
}

class HeightProfileFitter {
 public:
  HeightProfileFitter(const HeightProfileOptions& options, const std::vector<GroundObservation>& observations)
      : options_(options), observations_(observations) {
    std::erase_if(observations_, [](const auto& o) { return !(o.sigma < kMaxRelativeSigma * o.inverse_height); });
  }

  std::optional<HeightProfile> Fit() {
    if (observations_.size() < kMinTracks) return std::nullopt;
    double inverse_height = MedianInverseHeight(observations_);
    for (int round = 0; round < 2; ++round) {  // the second with nodes that are a height apart
      SetNodes(inverse_height);
      Search();
      inverse_height = Median(profile_.inverse_heights);
    }
    const GroundLikelihood likelihood(observations_);
    for (int i = 0; i < kIterations; ++i) {
      EstimateGroundProbabilities(likelihood);
      Smooth();
    }
    Summarize();
    const HeightProfileQuality& quality = profile_.quality;
    spdlog::debug(
        "odometry: {} of {} tracks below the path lie on the ground, evidence {:.1f}, noise factor {:.2f}, "
        "roll {:.4f} rad, {:.2f} % in common, on {:.0f} % of the path, {:.0f} % covered, uncertain by {:.2f} %",
        quality.inliers, observations_.size(), quality.evidence, noise_factor_, Median(profile_.rolls),
        100.0 * CommonSigma(), 100.0 * SeenRatio(), 100.0 * quality.covered_ratio, 100.0 * quality.relative_sigma);
    const bool found = quality.inliers >= kMinTracks && quality.evidence >= kMinEvidence &&
                       noise_factor_ < kMaxNoiseFactor && CommonSigma() < kMaxCommonSigma &&
                       SeenRatio() >= kMinSeenRatio;
    return found ? std::optional(profile_) : std::nullopt;
  }

 private:
  NodeFraction LocateNode(double arc_length) const {
    return Locate(profile_.spacing, profile_.inverse_heights.size(), arc_length);
  }

  std::size_t NearestNode(const GroundObservation& o) const {
    const auto [node, fraction] = LocateNode(o.arc_length);
    return fraction < 0.5 ? node : node + 1;
  }

  void SetNodes(double inverse_height) {
    profile_.spacing = std::max(1.0 / inverse_height, options_.path_length / kMaxNodes);
    profile_.inverse_heights.assign(static_cast<std::size_t>(options_.path_length / profile_.spacing) + 2,
                                    inverse_height);
    profile_.rolls.assign(profile_.inverse_heights.size(), 0.0);
    break_after_.assign(profile_.inverse_heights.size(), false);
    for (const double arc_length : options_.scale_breaks) break_after_[LocateNode(arc_length).node] = true;
  }

  /// Relative standard deviation of the height's change from a node to the next.
  double StepSigma(std::size_t node) const {
    return break_after_[node] ? kBreakSigma : options_.scale_drift * std::sqrt(profile_.spacing);
  }

  void Search() {
    const std::size_t nodes = profile_.inverse_heights.size();
    GroundSections sections;
    for (const auto& o : observations_) sections.section.push_back(LocateNode(o.arc_length).node / kSectionNodes);
    const std::size_t count = (nodes - 1) / kSectionNodes + 1;
    for (std::size_t k = 0; k + 1 < count; ++k) {
      double variance = 0.0;
      for (std::size_t node = k * kSectionNodes; node < (k + 1) * kSectionNodes; ++node) {
        variance += std::pow(StepSigma(node), 2);
      }
      sections.step_sigmas.push_back(std::sqrt(variance));
    }
    const FoundGround ground = SearchGround(observations_, sections);
    profile_.quality.evidence = ground.evidence;
    for (std::size_t node = 0; node < nodes; ++node) {
      profile_.inverse_heights[node] = std::exp(ground.log_inverse_heights[node / kSectionNodes]);
      profile_.rolls[node] = ground.roll;
    }
  }

  struct Residual {
    double error;  // relative
    double sigma;  // relative, with the estimated noise factor
  };
  Residual Compare(const GroundObservation& o) const {
    const auto [node, fraction] = LocateNode(o.arc_length);
    const double x = profile_.InverseHeight(o.arc_length);
    const double roll = (1.0 - fraction) * profile_.rolls[node] + fraction * profile_.rolls[node + 1];
    return {o.inverse_height / x - (1.0 - roll * o.lateral_ratio), std::hypot(noise_factor_ * o.sigma / x, kRoughness)};
  }

  /// Also the factor common to the observations' standard deviations.
  void EstimateGroundProbabilities(const GroundLikelihood& likelihood) {
    ground_probabilities_.resize(observations_.size());
    std::vector<double> ratios;
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      const GroundObservation& o = observations_[i];
      const auto [error, sigma] = Compare(o);
      ground_probabilities_[i] = likelihood.GroundProbability(i, error, sigma);
      if (ground_probabilities_[i] < 0.5) continue;
      ratios.push_back(std::abs(error) * profile_.InverseHeight(o.arc_length) / o.sigma);
    }
    profile_.quality.inliers = ratios.size();
    noise_factor_ = std::clamp(kMadToSigma * Median(ratios), kMinNoiseFactor, kMaxNoiseFactor);
  }

  void Smooth() {
    PlaneSmoother smoother(profile_.inverse_heights.size());
    std::vector<double> weights;
    std::vector<double> node_weights(profile_.inverse_heights.size());  // relative
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      weights.push_back(ground_probabilities_[i] / std::pow(Compare(observations_[i]).sigma, 2));
      node_weights[NearestNode(observations_[i])] += weights.back();
    }
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      const GroundObservation& o = observations_[i];
      const auto [node, fraction] = LocateNode(o.arc_length);
      const double x = profile_.InverseHeight(o.arc_length);
      const double common = 1.0 + kRocking * kRocking * node_weights[NearestNode(o)];
      smoother.AddObservation(node, fraction, {1.0, -o.lateral_ratio}, o.inverse_height, weights[i] / (common * x * x));
    }
    for (std::size_t k = 0; k + 1 < break_after_.size(); ++k) {
      const double x = profile_.inverse_heights[k];
      const double height_sigma = StepSigma(k) * x;
      const double roll_sigma = options_.roll_drift * std::sqrt(profile_.spacing * x) * x;
      smoother.AddStep(k, {1.0 / (height_sigma * height_sigma), 1.0 / (roll_sigma * roll_sigma)});
    }
    const double roll_sigma = kRollSigma * profile_.inverse_heights[0];
    smoother.AddPrior(0, {0.0, 0.0}, {0.0, 1.0 / (roll_sigma * roll_sigma)});
    const auto solution = smoother.Solve();
    relative_sigmas_.clear();
    for (std::size_t k = 0; k < solution.values.size(); ++k) {
      profile_.inverse_heights[k] = solution.values[k].x();
      profile_.rolls[k] = solution.values[k].y() / solution.values[k].x();
      relative_sigmas_.push_back(std::sqrt(solution.covariances[k](0, 0)) / solution.values[k].x());
    }
  }

  /// Ratio of the sections in which there are tracks on the ground.
  double SeenRatio() const {
    std::vector<bool> seen((profile_.inverse_heights.size() - 1) / kSectionNodes + 1, false);
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      if (ground_probabilities_[i] > 0.5) seen[LocateNode(observations_[i].arc_length).node / kSectionNodes] = true;
    }
    return static_cast<double>(std::ranges::count(seen, true)) / static_cast<double>(seen.size());
  }

  /// Relative standard deviation of the height that the tracks on the ground within an arc of one height have in
  /// common, beyond their own noise.
  double CommonSigma() const {
    std::vector<double> weights(profile_.inverse_heights.size());
    std::vector<double> sums(weights.size());
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      if (ground_probabilities_[i] < 0.5) continue;
      const auto [error, sigma] = Compare(observations_[i]);
      const std::size_t node = NearestNode(observations_[i]);
      weights[node] += 1.0 / (sigma * sigma);
      sums[node] += error / (sigma * sigma);
    }
    double excess = 0.0;
    double total = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      if (!(weights[k] > 0.0)) continue;
      excess += sums[k] * sums[k] / weights[k] - 1.0;  // weighted by the certainty of the node's mean
      total += weights[k];
    }
    return total > 0.0 ? std::sqrt(std::max(0.0, excess / total)) : 0.0;
  }

  void Summarize() {
    profile_.path_length_in_heights = options_.path_length / profile_.spacing;
    const auto covered = std::ranges::count_if(relative_sigmas_, [](double sigma) { return sigma < kCoveredSigma; });
    profile_.quality.covered_ratio = static_cast<double>(covered) / static_cast<double>(relative_sigmas_.size());
    profile_.quality.relative_sigma = Median(relative_sigmas_);
  }

  const HeightProfileOptions& options_;
  std::vector<GroundObservation> observations_;
  HeightProfile profile_;
  std::vector<bool> break_after_;             // the scale was lost between each node and the next
  std::vector<double> relative_sigmas_;       // of the nodes' inverse heights
  std::vector<double> ground_probabilities_;  // of the observations
  double noise_factor_ = 1.0;
};

}  // namespace

double HeightProfile::InverseHeight(double arc_length) const {
  const auto [node, fraction] = Locate(spacing, inverse_heights.size(), arc_length);
  return (1.0 - fraction) * inverse_heights[node] + fraction * inverse_heights[node + 1];
}

std::optional<HeightProfile> FitHeightProfile(const HeightProfileOptions& options,
                                              const std::vector<GroundObservation>& observations) {
  return HeightProfileFitter(options, observations).Fit();
}

}  // namespace evo::odometry
