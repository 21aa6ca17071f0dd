#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/events/event_history.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/tracking/tracker_options.hpp"
#include "tracking/smoothing/observed_window.hpp"

namespace evo::tracking {

/// A feature that was observed in more frames than this is not rejected any more, so that its observations are final.
inline constexpr int kMaxRejectionAge = 100;

/// Tracks features from event frame to event frame. An event frame is an instant with a window of events around it.
/// Each frame takes three calls, in this order: Track, EstimateMotion, UpdateFeatures.
class Tracker {
 public:
  virtual ~Tracker() = default;

  /// Tracks all features to the frame at `t`. `history` must hold the events of [t - before(), t + after()].
  virtual void Track(const events::EventHistory& history, TimeNs t) = 0;
  /// Estimates the camera's motion in this frame. It reads no events, so the history may grow at the same time.
  virtual void EstimateMotion() = 0;
  /// Rejects outliers and detects new features. `history` must hold the events that Track asks for.
  virtual void UpdateFeatures(const events::EventHistory& history) = 0;

  /// Duration of the events that a frame needs before and after its stamp.
  virtual TimeNs before() const = 0;
  virtual TimeNs after() const = 0;

  /// The live features that are not rejected in the last frame, by ascending id.
  virtual events::Tracks Observations() const = 0;
  /// The window of each of these observations.
  virtual std::vector<ObservedWindow> Windows() const = 0;
  /// The ids of the features that the last frame rejected with all their observations.
  virtual std::vector<std::int64_t> Rejected() const = 0;
  /// Whether the last frame was a key frame: new features were detected in it.
  virtual bool is_key_frame() const = 0;
};

/// Makes the tracker that `options.method` names.
std::unique_ptr<Tracker> MakeTracker(const geometry::Camera& camera, const TrackerOptions& options, ThreadPool* pool);

}  // namespace evo::tracking
