#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/events/event_history.hpp"
#include "evo/tracking/density_map.hpp"
#include "evo/tracking/em_affine.hpp"
#include "evo/tracking/flow_field.hpp"
#include "evo/tracking/tracker.hpp"

namespace evo {

/// A live feature: a template of events and where it is now.
struct TrackedFeature {
  std::int64_t id = 0;
  Eigen::Vector2d position;                              ///< px, at the stamp of the last event frame
  Eigen::Vector2d flow;                                  ///< px/s
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();  ///< template to sensor
  double scale = 1.0;                                    ///< of the patch against its first window
  DensityMap events;                                     ///< the template
  int frames = 1;                                        ///< lifetime so far
};

/// Tracks features by expectation maximisation. The positions reported are those at the very instant of the event
/// frame, whatever the window of each feature.
class FeatureTracker : public Tracker {
 public:
  FeatureTracker(int width, int height, const TrackerOptions& options, ThreadPool* pool);

  void Process(const EventHistory& history, TimeNs t) override;
  TimeNs before() const override { return FromSeconds(0.5 * options_.longest_window_s); }
  TimeNs after() const override { return before(); }
  Tracks Observations() const override;
  bool detected() const override { return detected_; }

 private:
  /// False if the feature is lost.
  bool Track(const EventHistory& history, TimeNs t, TrackedFeature* feature) const;
  bool Align(const EventHistory& history, TimeNs t, TrackedFeature* feature) const;
  /// Aligns `events` to the feature's template from `motion`; false if they do not fit it.
  bool Fit(const LocalEvents& events, const TrackedFeature& feature, TimeNs half_window, bool coarse_first,
           PatchMotion* motion) const;
  void Refill(const EventHistory& history, TimeNs t);
  std::optional<TrackedFeature> Birth(const EventHistory& history, TimeNs t, const Eigen::Vector2d& position) const;
  void UpdateTemplate(const LocalEvents& events, const PatchMotion& motion, TrackedFeature* feature) const;
  int planes() const { return options_.use_polarity ? 2 : 1; }

  TrackerOptions options_;
  int width_;
  int height_;
  ThreadPool* pool_;
  FlowField flow_field_;
  RefillPolicy refill_;
  std::vector<TrackedFeature> features_;
  std::int64_t next_id_ = 0;
  std::optional<TimeNs> last_;
  bool detected_ = false;
};

}  // namespace evo
