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

/// Holds what a tracker sees until it is final, some ten seconds, and passes it on then in the same order: with shake
/// given back where `options.rotation_spline` asks for it (see RestoreShake), and without the observations of features
/// that were withdrawn or seen in one frame only.
class TrackBuffer {
 public:
  TrackBuffer(const geometry::Camera& camera, const TrackerOptions& options, ThreadPool* pool, events::TrackSink sink);

  /// A frame later than the one before: its observations by ascending id, the windows that they come from and the
  /// features withdrawn, see Tracker. A feature is seen in all frames from its first to its last.
  void Add(TimeNs t, const events::Tracks& observations, std::span<const ObservedWindow> windows,
           std::span<const std::int64_t> withdrawn);
  /// Passes on all that is left.
  void Finish();

  /// What is held, as it was seen.
  const events::Tracks& held() const { return held_; }

 private:
  /// Those seen in the last frame, but neither in the one before it nor in the `newest`.
  void WithdrawLone(const std::vector<std::int64_t>& newest);
  /// Passes on what was seen in the first `stretches` stretches of what is held.
  void Release(std::size_t stretches);
  /// Index of the first observation held that is not before `t`.
  std::size_t IndexOf(TimeNs t) const;

  geometry::Camera camera_;
  JacobianTable lens_;
  bool restore_shake_;
  ThreadPool* pool_;
  events::TrackSink sink_;
  TimeNs delay_;                          // what was seen this long ago is final
  TimeNs last_ = 0;                       // stamp of the last frame
  std::vector<std::int64_t> last_ids_;    // in it, ascending
  std::vector<std::int64_t> ids_before_;  // in the frame before it
  std::optional<TimeNs> from_;            // what was seen before has been passed on; empty before anything is seen
  events::Tracks held_;                   // from as long before as its neighbours' shake may depend on
  std::vector<ObservedWindow> windows_;
  std::unordered_map<std::int64_t, TimeNs> withdrawn_;  // features that were seen until here at most
};

}  // namespace evo::tracking
