#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/events/event_history.hpp"
#include "evo/tracking/tracker_options.hpp"
#include "tracking/detection/flow_field.hpp"
#include "tracking/detection/refill_policy.hpp"
#include "tracking/motion/ego_motion.hpp"
#include "tracking/sensor_area.hpp"
#include "tracking/tracked_feature.hpp"

namespace evo::tracking {

/// Initialises features: corners of a motion-compensated event image whose events constrain them in both directions.
class FeatureInitializer {
 public:
  FeatureInitializer(int width, int height, const TrackerOptions& options, const EgoMotion& ego_motion,
                     ThreadPool* pool);

  /// Whether features are due with so many `alive`. Must be called once a frame.
  bool IsDue(std::size_t alive) { return refill_.IsDue(alive); }
  /// Appends new features at `t`, as many as are missing at most.
  void AddFeatures(const events::EventHistory& history, TimeNs t, std::vector<TrackedFeature>* features);

 private:
  struct Candidate {
    TrackedFeature feature;
    double information;  // 1/px^2, see AssociationTable, in the worst direction
  };

  /// Estimates the optical flow of the whole image (EM 1 of A. Z. Zhu et al.).
  void UpdateFlowField(const events::EventHistory& history, TimeNs t, const std::vector<TrackedFeature>& features,
                       const std::vector<DepthSample>& depths);
  /// Corners of the motion-compensated event image, px: some more than are missing.
  std::vector<Eigen::Vector2d> FindCorners(const events::EventHistory& history, TimeNs t,
                                           const std::vector<TrackedFeature>& features) const;
  /// Makes a feature at a corner. Empty if its events are too few or contradict a static point.
  std::optional<Candidate> MakeCandidate(const events::EventHistory& history, TimeNs t, const Eigen::Vector2d& position,
                                         const std::vector<DepthSample>& depths) const;
  /// The information that a candidate must have: the `uninformative_ratio` of the last candidates, accepted or not,
  /// have less.
  double MinInformation(const std::vector<Candidate>& candidates);

  TrackerOptions options_;
  SensorArea area_;
  const EgoMotion& ego_motion_;
  ThreadPool* pool_;
  RefillPolicy refill_;
  FlowField flow_field_;
  std::deque<double> recent_informations_;  // of the last candidates
  std::int64_t next_id_ = 0;
};

}  // namespace evo::tracking
