#include "evo/odometry/resampling.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace evo::odometry {

namespace {

constexpr std::size_t kFitSightings = 4;  // fewer are interpolated instead

using Sighting = events::TrackObservation;

/// Value at `t` of the least-squares line through the sightings.
Eigen::Vector2d FitLine(const Sighting* begin, const Sighting* end, TimeNs t) {
  double sum_t = 0.0, sum_tt = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), sum_with_t = Eigen::Vector2d::Zero();
  for (const Sighting* s = begin; s != end; ++s) {
    const double dt = ToSeconds(s->t - t);
    const Eigen::Vector2d position(s->x, s->y);
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

/// One track's position at `t`, its sightings in order of time; empty outside its life and in its gaps.
std::optional<Eigen::Vector2d> PositionAt(const std::vector<Sighting>& track, TimeNs t,
                                          const ResamplingOptions& options) {
  const auto after = std::ranges::lower_bound(track, t, {}, &Sighting::t);
  if (after == track.end() || (after == track.begin() && after->t != t)) return std::nullopt;
  const auto before = after->t == t ? after : after - 1;
  const TimeNs gap = after->t - before->t;
  if (gap > FromSeconds(options.max_gap_s)) return std::nullopt;
  const TimeNs window = FromSeconds(options.fit_window_s);
  const auto begin = std::ranges::lower_bound(track, t - window, {}, &Sighting::t);
  const auto end = std::ranges::upper_bound(track, t + window, {}, &Sighting::t);
  if (static_cast<std::size_t>(end - begin) >= kFitSightings && begin->t < t && (end - 1)->t > t) {
    return FitLine(&*begin, &*begin + (end - begin), t);
  }
  const double s = gap > 0 ? static_cast<double>(t - before->t) / static_cast<double>(gap) : 0.0;
  return Eigen::Vector2d((1.0 - s) * before->x + s * after->x, (1.0 - s) * before->y + s * after->y);
}

}  // namespace

bool AreSynchronous(const events::Tracks& tracks, int least) {
  std::size_t shared = 0;
  for (auto begin = tracks.begin(); begin != tracks.end();) {
    const auto end = std::find_if(begin, tracks.end(), [&](const Sighting& s) { return s.t != begin->t; });
    if (end - begin >= least) shared += static_cast<std::size_t>(end - begin);
    begin = end;
  }
  return 2 * shared > tracks.size();
}

events::Tracks Resample(const events::Tracks& tracks, const ResamplingOptions& options) {
  events::Tracks resampled;
  if (tracks.empty()) return resampled;
  std::map<std::int64_t, std::vector<Sighting>> by_id;
  for (const auto& sighting : tracks) by_id[sighting.id].push_back(sighting);
  const TimeNs start = tracks.front().t;
  const TimeNs interval = FromSeconds(options.frame_interval_s);
  for (const auto& [id, track] : by_id) {
    const auto frame_from = [&](TimeNs t) { return start + (t - start + interval - 1) / interval * interval; };
    for (TimeNs t = frame_from(track.front().t); t <= track.back().t;) {
      const auto position = PositionAt(track, t, options);
      if (position) resampled.push_back({id, t, position->x(), position->y()});
      // A gap may hold more frames than can be counted through.
      t = position ? t + interval : frame_from(std::ranges::lower_bound(track, t, {}, &Sighting::t)->t);
    }
  }
  std::ranges::stable_sort(resampled, {}, &Sighting::t);  // ids are in order already
  return resampled;
}

}  // namespace evo::odometry
