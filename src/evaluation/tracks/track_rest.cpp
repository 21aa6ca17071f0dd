#include "evo/evaluation/track_rest.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace evo::evaluation {

namespace {

constexpr TimeNs kSecond = 1'000'000'000;

/// The value that a quarter of the values exceed.
float UpperQuartile(std::vector<float> values) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
  std::nth_element(values.begin(), place, values.end(), std::greater<>());
  return *place;
}

}  // namespace

void RestCounter::Count(const Life& life, Seconds* seconds) {
  if (life.frames < kMinRestFrames) return;
  const double speed =
      std::hypot(life.last.x - life.first.x, life.last.y - life.first.y) / ToSeconds(life.last.t - life.first.t);
  const std::int64_t begin = life.first.t / kSecond;
  const std::int64_t end = life.last.t / kSecond;
  for (std::int64_t second = begin; second <= end; ++second) {
    Second& counts = (*seconds)[second];
    counts.speeds.push_back(static_cast<float>(speed));
    if (speed < kRestSpeed) counts.resting += static_cast<double>(life.frames) / static_cast<double>(end - begin + 1);
  }
}

void RestCounter::Add(std::span<const events::TrackObservation> observations) {
  if (observations.empty()) return;
  observations_ += observations.size();
  for (const auto& observation : observations) {
    const auto [life, is_new] = open_.try_emplace(observation.id, Life{observation, observation, 0});
    life->second.last = observation;
    ++life->second.frames;
  }
  std::erase_if(open_, [&](const auto& entry) {
    const bool ended = entry.second.last.t < observations.back().t;
    if (ended) Count(entry.second, &seconds_);
    return ended;
  });
}

RestStatistics RestCounter::Statistics() const {
  RestStatistics statistics;
  statistics.observations = observations_;
  if (observations_ == 0) return statistics;
  Seconds seconds = seconds_;
  for (const auto& [id, life] : open_) Count(life, &seconds);
  double resting = 0.0;
  double resting_while_moving = 0.0;
  for (const auto& [second, counts] : seconds) {
    resting += counts.resting;
    if (UpperQuartile(counts.speeds) > kMovingSpeed) resting_while_moving += counts.resting;
  }
  statistics.ratio = resting / static_cast<double>(observations_);
  statistics.moving_ratio = resting_while_moving / static_cast<double>(observations_);
  return statistics;
}

}  // namespace evo::evaluation
