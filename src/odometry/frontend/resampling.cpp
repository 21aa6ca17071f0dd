#include "evo/odometry/resampling.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <map>
#include <optional>
#include <vector>

namespace evo::odometry {

namespace {

using events::TrackObservation;

constexpr std::size_t kMinFitObservations = 4;  // a line through fewer is hardly better than interpolation

/// The value at `t` of the least-squares line through the observations [begin, end), px.
Eigen::Vector2d FitLine(const TrackObservation* begin, const TrackObservation* end, TimeNs t) {
  double sum_t = 0.0, sum_tt = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), sum_with_t = Eigen::Vector2d::Zero();
  for (const TrackObservation* observation = begin; observation != end; ++observation) {
    const double dt = ToSeconds(observation->t - t);
    const Eigen::Vector2d position(observation->x, observation->y);
    sum_t += dt;
    sum_tt += dt * dt;
    sum += position;
    sum_with_t += dt * position;
  }
  const double n = static_cast<double>(end - begin);
  const double determinant = n * sum_tt - sum_t * sum_t;
  if (!(determinant > 1e-12 * n * sum_tt)) return sum / n;  // all at one instant
  return (sum_tt * sum - sum_t * sum_with_t) / determinant;
}

/// A track's position at `t`, px; empty outside its life and in its gaps. `track` is in order of time.
std::optional<Eigen::Vector2d> InterpolatePosition(const std::vector<TrackObservation>& track, TimeNs t,
                                                   const ResamplingOptions& options) {
  const auto after = std::ranges::lower_bound(track, t, {}, &TrackObservation::t);
  if (after == track.end() || (after == track.begin() && after->t != t)) return std::nullopt;
  const auto before = after->t == t ? after : after - 1;
  const TimeNs gap = after->t - before->t;
  if (gap > FromSeconds(options.max_gap_s)) return std::nullopt;
  const TimeNs window = FromSeconds(options.fit_window_s);
  const auto begin = std::ranges::lower_bound(track, t - window, {}, &TrackObservation::t);
  const auto end = std::ranges::upper_bound(track, t + window, {}, &TrackObservation::t);
  if (static_cast<std::size_t>(end - begin) >= kMinFitObservations && begin->t < t && (end - 1)->t > t) {
    return FitLine(&*begin, &*begin + (end - begin), t);
  }
  const double s = gap > 0 ? static_cast<double>(t - before->t) / static_cast<double>(gap) : 0.0;
  return Eigen::Vector2d((1.0 - s) * before->x + s * after->x, (1.0 - s) * before->y + s * after->y);
}

}  // namespace

bool AreSynchronous(const events::Tracks& tracks, int min_features) {
  std::size_t in_frames = 0;
  for (auto begin = tracks.begin(); begin != tracks.end();) {
    const auto end = std::find_if(begin, tracks.end(), [&](const TrackObservation& o) { return o.t != begin->t; });
    if (end - begin >= min_features) in_frames += static_cast<std::size_t>(end - begin);
    begin = end;
  }
  return 2 * in_frames > tracks.size();
}

events::Tracks Resample(const events::Tracks& tracks, const ResamplingOptions& options) {
  events::Tracks resampled;
  if (tracks.empty()) return resampled;
  std::map<std::int64_t, std::vector<TrackObservation>> by_id;
  for (const auto& observation : tracks) by_id[observation.id].push_back(observation);
  const TimeNs start = tracks.front().t;
  const TimeNs interval = FromSeconds(options.frame_interval_s);
  const auto next_frame = [&](TimeNs t) { return start + (t - start + interval - 1) / interval * interval; };
  for (const auto& [id, track] : by_id) {
    for (TimeNs t = next_frame(track.front().t); t <= track.back().t;) {
      const auto position = InterpolatePosition(track, t, options);
      if (position) resampled.push_back({id, t, position->x(), position->y()});
      // A gap is skipped at once: it may last years.
      t = position ? t + interval : next_frame(std::ranges::lower_bound(track, t, {}, &TrackObservation::t)->t);
    }
  }
  std::ranges::stable_sort(resampled, {}, &TrackObservation::t);  // the ids are in order already
  return resampled;
}

}  // namespace evo::odometry
