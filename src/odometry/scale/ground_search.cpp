#include "odometry/scale/ground_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace evo::odometry {

namespace {

constexpr double kHeightStep = 0.01;  // of log(inverse height)
constexpr double kRollStep = 0.01;    // rad
constexpr double kMaxRoll = 0.12;     // rad
constexpr double kRollSigma = 0.05;   // rad, prior
constexpr double kRoughness = 0.015;  // of the ground in heights, with what a roll between two steps makes of it
constexpr double kReachSigmas = 4.0;  // beyond it an observation is not on the ground

/// The best path through the grid of sections and heights.
class HeightGrid {
 public:
  HeightGrid(const std::vector<GroundObservation>& observations, const GroundSections& sections)
      : observations_(observations), sections_(sections), likelihood_(observations) {
    const auto by_height = [](const GroundObservation& o) { return o.inverse_height; };
    const auto [low, high] = std::ranges::minmax(observations, {}, by_height);
    min_log_ = std::log(low.inverse_height);
    states_ = static_cast<std::size_t>((std::log(high.inverse_height) - min_log_) / kHeightStep) + 2;
  }

  FoundGround Search(double roll) const {
    const std::size_t count = sections_.step_sigmas.size() + 1;
    const std::vector<std::vector<float>> scores = ScoreSections(roll, count);
    std::vector<std::vector<std::uint32_t>> previous(count);
    std::vector<float> best = scores[0];
    for (std::size_t k = 1; k < count; ++k) best = Step(best, sections_.step_sigmas[k - 1], scores[k], &previous[k]);
    const auto end = std::ranges::max_element(best);
    FoundGround ground{std::vector<double>(count), roll, *end - 0.5 * roll * roll / (kRollSigma * kRollSigma)};
    auto state = static_cast<std::size_t>(end - best.begin());
    for (std::size_t k = count; k-- > 0;) {
      ground.log_inverse_heights[k] = Log(state);
      if (k > 0) state = previous[k][state];
    }
    return ground;
  }

 private:
  double Log(std::size_t state) const { return min_log_ + kHeightStep * static_cast<double>(state); }

  /// Sums of the observations' log likelihood ratios.
  std::vector<std::vector<float>> ScoreSections(double roll, std::size_t count) const {
    std::vector<std::vector<float>> scores(count, std::vector<float>(states_));
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      const GroundObservation& o = observations_[i];
      const double slope = 1.0 - roll * o.lateral_ratio;
      if (!(slope > 0.0)) continue;
      const double log = std::log(o.inverse_height / slope);
      const double sigma = std::hypot(o.sigma / o.inverse_height, kRoughness);
      std::vector<float>& score = scores[sections_.section[i]];
      const auto far = [&](double error) { return static_cast<float>(std::log(likelihood_.Ratio(i, error, sigma))); };
      const float above = far(kReachSigmas * sigma);
      const float below = far(-kReachSigmas * sigma);
      const float deep = far(-std::max(kMaxBelowGround, kReachSigmas * sigma));
      for (std::size_t s = 0; s < states_; ++s) {
        const double error = log - Log(s);
        if (std::abs(error) < kReachSigmas * sigma) {
          score[s] += far(error);
        } else {
          score[s] += error > 0.0 ? above : error > -kMaxBelowGround ? below : deep;
        }
      }
    }
    return scores;
  }

  /// Scores of the best paths to every state of the next section.
  std::vector<float> Step(const std::vector<float>& best, double sigma, const std::vector<float>& score,
                          std::vector<std::uint32_t>* previous) const {
    const auto reach = static_cast<std::size_t>(kReachSigmas * sigma / kHeightStep) + 1;
    std::vector<float> next(states_);
    previous->resize(states_);
    for (std::size_t s = 0; s < states_; ++s) {
      float highest = -std::numeric_limits<float>::infinity();
      for (std::size_t from = s - std::min(s, reach); from < std::min(states_, s + reach + 1); ++from) {
        const double u = kHeightStep * (static_cast<double>(from) - static_cast<double>(s)) / sigma;
        const float value = best[from] - static_cast<float>(0.5 * u * u);
        if (value > highest) {
          highest = value;
          (*previous)[s] = static_cast<std::uint32_t>(from);
        }
      }
      next[s] = highest + score[s];
    }
    return next;
  }

  const std::vector<GroundObservation>& observations_;
  const GroundSections& sections_;
  GroundLikelihood likelihood_;
  double min_log_ = 0.0;
  std::size_t states_ = 0;
};

}  // namespace

FoundGround SearchGround(const std::vector<GroundObservation>& observations, const GroundSections& sections) {
  const HeightGrid grid(observations, sections);
  FoundGround found{{}, 0.0, -std::numeric_limits<double>::infinity()};
  const int rolls = static_cast<int>(std::lround(kMaxRoll / kRollStep));
  for (int i = -rolls; i <= rolls; ++i) {
    FoundGround ground = grid.Search(kRollStep * i);
    if (ground.evidence > found.evidence) found = std::move(ground);
  }
  return found;
}

}  // namespace evo::odometry
