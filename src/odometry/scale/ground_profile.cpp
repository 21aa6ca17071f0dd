#include "odometry/scale/ground_profile.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "evo/core/median.hpp"

namespace evo::odometry {

namespace {

constexpr double kVoteWidth = 0.05;    // of the logarithm of the height
constexpr double kVoteStep = 0.02;     // between the heights that are tried
constexpr double kLargestSigma = 0.1;  // relative; a track less certain than this tells nothing
constexpr double kRoughness = 0.01;    // of the ground, in heights
constexpr double kRollPrior = 0.05;    // rad
constexpr double kBreak = 0.3;         // change of the scale where it was lost, relative
constexpr double kTukey = 4.685;       // 95 % efficiency under Gaussian noise
constexpr double kMadToSigma = 1.4826;
// Tracks of a ground scatter as their own residuals make one expect; those of something else more.
constexpr double kLeastNoise = 0.1;
constexpr double kMostNoise = 2.0;
// Relative distances from the profile within which sightings take part, from coarse to fine; then their noise decides.
constexpr std::array kGates = {0.3, 0.2, 0.15, 0.1, 0.07, 0.05, 0.03, 0.0, 0.0, 0.0};
constexpr double kMostNodes = 1e5;  // whatever height garbage suggests
constexpr std::size_t kFewestTracks = 20;
constexpr std::size_t kStretch = 10;  // heights of way, on which most sightings have to agree
constexpr double kSmallestShare = 0.5;
constexpr double kSmallestAgreement = 0.9;  // share of the stretches
constexpr double kCoveredError = 0.01;

/// The inverse height that most sightings are near to, the certain ones counting more; 0 without any.
double MostCommon(const std::vector<GroundSighting>& sightings) {
  struct Vote {
    double at;  // logarithm
    double weight;
  };
  std::vector<Vote> votes;
  for (const auto& sighting : sightings) {
    const double sigma = sighting.sigma / sighting.inverse_height;
    votes.push_back({std::log(sighting.inverse_height), 1.0 / (sigma * sigma + kVoteWidth * kVoteWidth)});
  }
  if (votes.empty()) return 0.0;
  std::ranges::sort(votes, {}, &Vote::at);
  Vote best{0.0, 0.0};
  std::size_t begin = 0;
  const int steps = static_cast<int>((votes.back().at - votes.front().at) / kVoteStep) + 1;
  for (int step = 0; step <= steps; ++step) {
    const double at = votes.front().at + kVoteStep * step;
    while (begin < votes.size() && votes[begin].at < at - 3.0 * kVoteWidth) ++begin;
    double sum = 0.0;
    for (std::size_t i = begin; i < votes.size() && votes[i].at < at + 3.0 * kVoteWidth; ++i) {
      const double u = (votes[i].at - at) / kVoteWidth;
      sum += votes[i].weight * std::exp(-0.5 * u * u);
    }
    if (sum > best.weight) best = {at, sum};
  }
  return std::exp(best.at);
}

/// Least squares over values of which each is tied to its neighbours only: a symmetric tridiagonal system.
struct Chain {
  explicit Chain(std::size_t size) : diagonal(size), beside(size), right(size) {}

  /// A measurement of the mean of the values `node` and `node` + 1, the latter with the weight `share`.
  void Add(std::size_t node, double share, double slope, double value, double weight) {
    const double a = slope * (1.0 - share);
    const double b = slope * share;
    diagonal[node] += weight * a * a;
    diagonal[node + 1] += weight * b * b;
    beside[node] += weight * a * b;
    right[node] += weight * a * value;
    right[node + 1] += weight * b * value;
  }

  void Tie(std::size_t node, double weight) {
    diagonal[node] += weight;
    diagonal[node + 1] += weight;
    beside[node] -= weight;
  }

  /// The values, and the variance of each.
  std::vector<double> Solve(std::vector<double>* variances) const {
    const std::size_t n = diagonal.size();
    std::vector<double> forward = diagonal;   // what is left of the diagonal with all before eliminated
    std::vector<double> backward = diagonal;  // and with all behind
    std::vector<double> values = right;
    for (std::size_t i = 1; i < n; ++i) {
      const double factor = beside[i - 1] / forward[i - 1];
      forward[i] -= factor * beside[i - 1];
      values[i] -= factor * values[i - 1];
    }
    values[n - 1] /= forward[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) {
      backward[i] -= beside[i] * beside[i] / backward[i + 1];
      values[i] = (values[i] - beside[i] * values[i + 1]) / forward[i];
    }
    variances->resize(n);
    for (std::size_t i = 0; i < n; ++i) (*variances)[i] = 1.0 / (forward[i] + backward[i] - diagonal[i]);
    return values;
  }

  std::vector<double> diagonal;
  std::vector<double> beside;  // to the next
  std::vector<double> right;
};

/// A place between two nodes.
struct Between {
  std::size_t node;
  double share;  // of the next node
};

Between Locate(const GroundProfile& profile, double along) {
  const std::size_t last = profile.inverse_height.size() - 1;
  const double at = std::clamp(along / profile.spacing, 0.0, static_cast<double>(last));
  const std::size_t node = std::min(static_cast<std::size_t>(at), last - 1);
  return {node, at - static_cast<double>(node)};
}

class ProfileFitter {
 public:
  ProfileFitter(const GroundProfileOptions& options, const std::vector<GroundSighting>& sightings)
      : options_(options), sightings_(sightings) {
    std::erase_if(sightings_, [](const auto& s) { return !(s.sigma < kLargestSigma * s.inverse_height); });
  }

  std::optional<GroundProfile> Fit() {
    if (sightings_.size() < kFewestTracks) return std::nullopt;
    Start();
    for (const double gate : kGates) {
      MeasureNoise(gate);
      if (!Step(gate)) return std::nullopt;
    }
    spdlog::debug("odometry: {} of {} tracks below the path lie on the ground, noise {:.2f}, roll {:.4f}",
                  profile_.tracks, sightings_.size(), noise_, profile_.roll);
    if (noise_ >= kMostNoise || Agreement() < kSmallestAgreement) return std::nullopt;
    Summarize();
    return profile_;
  }

 private:
  /// Each piece between breaks starts with its most common height.
  void Start() {
    const double usual = MostCommon(sightings_);
    profile_.spacing = std::max(1.0 / usual, options_.length / kMostNodes);
    profile_.inverse_height.assign(static_cast<std::size_t>(options_.length / profile_.spacing) + 2, usual);
    broken_.assign(profile_.inverse_height.size(), false);
    for (const double at : options_.breaks) broken_[Locate(profile_, at).node] = true;
    std::vector<std::vector<GroundSighting>> around(broken_.size());
    for (const auto& sighting : sightings_) around[Locate(profile_, sighting.along).node].push_back(sighting);
    std::vector<GroundSighting> piece;
    for (std::size_t begin = 0, k = 0; k < broken_.size(); ++k) {
      piece.insert(piece.end(), around[k].begin(), around[k].end());
      if (!broken_[k] && k + 1 < broken_.size()) continue;
      const double start = piece.size() < kFewestTracks ? usual : MostCommon(piece);
      for (; begin <= k; ++begin) profile_.inverse_height[begin] = start;
      piece.clear();
    }
  }

  struct Residual {
    double error;  // relative
    double sigma;  // relative, with the noise as measured
  };
  Residual Compare(const GroundSighting& s) const {
    const double x = profile_.InverseHeight(s.along);
    return {s.inverse_height / x - (1.0 - profile_.roll * s.sideways), std::hypot(noise_ * s.sigma / x, kRoughness)};
  }

  /// The factor of the sightings' standard deviations.
  void MeasureNoise(double gate) {
    std::vector<double> ratios;
    for (const auto& s : sightings_) {
      const auto [error, sigma] = Compare(s);
      if (std::abs(error) > std::max(gate, 3.0 * sigma)) continue;
      ratios.push_back(std::abs(error) * profile_.InverseHeight(s.along) / s.sigma);
    }
    noise_ = std::clamp(kMadToSigma * Median(ratios), kLeastNoise, kMostNoise);
  }

  /// One solution for the heights and the roll. False if too few sightings agree.
  bool Step(double gate) {
    Chain chain(profile_.inverse_height.size());
    double roll_weight = 1.0 / (kRollPrior * kRollPrior);
    double roll_right = 0.0;
    profile_.tracks = 0;
    for (const auto& s : sightings_) {
      const auto [error, sigma] = Compare(s);
      const double u = error / std::max(gate, kTukey * sigma);
      if (std::abs(u) >= 1.0) continue;
      ++profile_.tracks;
      const double weight = std::pow((1.0 - u * u) / sigma, 2);
      const auto [node, share] = Locate(profile_, s.along);
      const double x = profile_.InverseHeight(s.along);
      chain.Add(node, share, 1.0 - profile_.roll * s.sideways, s.inverse_height, weight / (x * x));
      roll_weight += weight * s.sideways * s.sideways;
      roll_right += weight * s.sideways * (1.0 - s.inverse_height / x);
    }
    if (profile_.tracks < kFewestTracks) return false;
    for (std::size_t k = 0; k + 1 < broken_.size(); ++k) {
      const double heights = profile_.spacing * profile_.inverse_height[k];
      const double change = (broken_[k] ? kBreak : options_.drift * std::sqrt(heights)) * profile_.inverse_height[k];
      chain.Tie(k, 1.0 / (change * change));
    }
    profile_.inverse_height = chain.Solve(&variances_);
    profile_.roll = roll_right / roll_weight;
    return true;
  }

  /// The share of the stretches in which most sightings agree with the profile, by their number of sightings.
  double Agreement() const {
    std::vector<std::size_t> all(profile_.inverse_height.size() / kStretch + 1);
    std::vector<std::size_t> agreeing(all.size());
    for (const auto& s : sightings_) {
      const auto [error, sigma] = Compare(s);
      const std::size_t k = Locate(profile_, s.along).node / kStretch;
      ++all[k];
      if (std::abs(error) < kTukey * sigma) ++agreeing[k];
    }
    std::size_t in_agreement = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (static_cast<double>(agreeing[k]) >= kSmallestShare * static_cast<double>(all[k])) in_agreement += all[k];
    }
    return static_cast<double>(in_agreement) / static_cast<double>(sightings_.size());
  }

  void Summarize() {
    profile_.heights = options_.length / profile_.spacing;
    std::vector<double> errors;
    for (std::size_t k = 0; k < variances_.size(); ++k) {
      errors.push_back(std::sqrt(variances_[k]) / profile_.inverse_height[k]);
    }
    const auto known = std::ranges::count_if(errors, [](double error) { return error < kCoveredError; });
    profile_.covered = static_cast<double>(known) / static_cast<double>(errors.size());
    profile_.error = Median(std::move(errors));
  }

  const GroundProfileOptions& options_;
  std::vector<GroundSighting> sightings_;
  GroundProfile profile_;
  std::vector<bool> broken_;       // between each node and the next
  std::vector<double> variances_;  // of the nodes
  double noise_ = 1.0;
};

}  // namespace

double GroundProfile::InverseHeight(double along) const {
  const auto [node, share] = Locate(*this, along);
  return (1.0 - share) * inverse_height[node] + share * inverse_height[node + 1];
}

std::optional<GroundProfile> FitGround(const GroundProfileOptions& options,
                                       const std::vector<GroundSighting>& sightings) {
  return ProfileFitter(options, sightings).Fit();
}

}  // namespace evo::odometry
