#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/core/time.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/tracking/tracker_options.hpp"
#include "tracking/motion/jacobian_table.hpp"
#include "tracking/smoothing/observed_window.hpp"

namespace evo::tracking {

/// Holds observations until they are final, about ten seconds, and passes them on in their order: with fast rotation
/// restored if `options.rotation_spline` is set (see RestoreRotation), and without the observations of features that
/// were rejected or observed in one frame only.
class TrackBuffer {
 public:
  TrackBuffer(const geometry::Camera& camera, const TrackerOptions& options, ThreadPool* pool, events::TrackSink sink);

  /// Adds the next frame: its observations by ascending id, their windows, and the ids of the features rejected in it
  /// (see Tracker). A feature is observed in all frames from its first to its last.
  void Add(TimeNs t, const events::Tracks& observations, std::span<const ObservedWindow> windows,
           std::span<const std::int64_t> rejected);
  /// Passes on all that is left.
  void Finish();

  /// The observations held, before their rotation is restored.
  const events::Tracks& held() const { return held_; }

 private:
  /// Rejects the features that were observed in the last frame, but neither before it nor in the `newest` one.
  void RejectSingleObservations(const std::vector<std::int64_t>& newest);
  /// Passes on the first `segments` segments of the observations held.
  void Release(std::size_t segments);
  /// Index of the first observation held whose stamp is not before `t`.
  std::size_t FirstIndexFrom(TimeNs t) const;

  geometry::Camera camera_;
  JacobianTable jacobians_;
  bool rotation_spline_;
  ThreadPool* pool_;
  events::TrackSink sink_;
  TimeNs delay_;                                       // an observation is final after this time
  TimeNs last_ = 0;                                    // stamp of the last frame
  std::vector<std::int64_t> last_ids_;                 // observed in the last frame, ascending
  std::vector<std::int64_t> previous_ids_;             // observed in the frame before it, ascending
  std::optional<TimeNs> from_;                         // begin of the next segment; empty before the first observation
  events::Tracks held_;                                // from kSplineMargin before `from_` on
  std::vector<ObservedWindow> windows_;                // of the observations held
  std::unordered_map<std::int64_t, TimeNs> rejected_;  // id, and a stamp that no observation of it exceeds
};

}  // namespace evo::tracking
