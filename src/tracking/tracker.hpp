#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/events/event_history.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/tracking/tracker_options.hpp"
#include "tracking/smoothing/observed_window.hpp"

namespace evo::tracking {

/// A feature that has been seen in more frames than this is not withdrawn any more.
inline constexpr int kOldestWithdrawn = 100;

/// Follows features from event frame to event frame. An event frame is an instant with a window of events around it.
class Tracker {
 public:
  virtual ~Tracker() = default;

  /// Takes all features to the frame at `t`; `history` must hold the events of [t - before(), t + after()]. Calls
  /// `read_ahead`, which may add later events to it, once at most, from any thread, where it has time to spare.
  virtual void Process(const events::EventHistory& history, TimeNs t, const std::function<void()>& read_ahead) = 0;
  virtual TimeNs before() const = 0;
  virtual TimeNs after() const = 0;

  /// The live features in the last frame, by ascending id.
  virtual events::Tracks Observations() const = 0;
  /// What each of them comes from; instants where the window is not around the stamp.
  virtual std::vector<ObservedWindow> Windows() const = 0;
  /// The ids of the features whose observations, as the last frame shows, are worth nothing; they are not observed from
  /// that frame on.
  virtual std::vector<std::int64_t> Withdrawn() const = 0;
  /// Whether the last frame was a key frame, where new features were detected.
  virtual bool detected() const = 0;
};

/// The tracker of `options.method`.
std::unique_ptr<Tracker> MakeTracker(const geometry::Camera& camera, const TrackerOptions& options, ThreadPool* pool);

/// When to look for new features: as soon as too few are alive, but not in every frame; sooner where most are missing.
class RefillPolicy {
 public:
  explicit RefillPolicy(const TrackerOptions& options)
      : fewest_(options.refill_below * options.features),
        few_(0.5 * options.features),
        pause_(options.frames_between_refills),
        frames_since_refill_(pause_) {}

  /// To be asked once in each frame.
  bool IsDue(std::size_t alive) {
    ++frames_since_refill_;
    const int pause = static_cast<double>(alive) < few_ ? (pause_ + 1) / 2 : pause_;
    const bool due = frames_since_refill_ >= pause && static_cast<double>(alive) < fewest_;
    if (due) frames_since_refill_ = 0;
    return due;
  }

 private:
  double fewest_;
  double few_;
  int pause_;
  int frames_since_refill_;
};

}  // namespace evo::tracking
