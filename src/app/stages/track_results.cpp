#include "app/stages/track_results.hpp"

#include <utility>

namespace evo::app {

TrackResults::TrackResults(std::filesystem::path path, const std::vector<std::string>& comments, events::Tracks* tracks)
    : writer_(std::move(path), comments), tracks_(tracks) {}

void TrackResults::Add(events::Tracks observations) {
  if (observations.empty()) return;
  io::RoundAsWritten(&observations);  // odometry from tracks.txt gives the same trajectory
  writer_.Write(observations);
  lifetimes_.Add(observations);
  rest_.Add(observations);
  lifetimes_.EndBefore(observations.back().t);
  for (const auto& observation : observations) {
    if (live_.empty() || live_.back().t != observation.t) live_.push_back({observation.t, 0});
    ++live_.back().features;
  }
  observations_ += observations.size();
  if (tracks_) tracks_->insert(tracks_->end(), observations.begin(), observations.end());
}

std::vector<report::LiveFeatures> TrackResults::CountLive(std::span<const TimeNs> frames) const {
  std::vector<report::LiveFeatures> live;
  auto seen = live_.begin();
  for (const TimeNs t : frames) {
    live.push_back({t, 0});
    if (seen != live_.end() && seen->t == t) live.back() = *seen++;
  }
  return live;
}

}  // namespace evo::app
