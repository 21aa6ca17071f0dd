#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "evo/core/time.hpp"
#include "tracking/feature_template.hpp"
#include "tracking/gating/outlier_evidence.hpp"
#include "tracking/motion/depth_samples.hpp"
#include "tracking/motion/flow_sample.hpp"

namespace evo::tracking {

/// A feature in the sensor at the stamp of the last event frame.
struct FeatureState {
  Eigen::Vector2d position;           ///< px, by its own events
  Eigen::Vector2d filtered_position;  ///< px, see EpipolarFilter; this one is reported
  Eigen::Vector2d flow;               ///< px/s
  PatchShape shape;

  FlowSample flow_sample() const { return {position, flow}; }
};

/// The plane that a feature lies on. Inverse depths are in units of the camera's speed, see EgoMotion.
class SurfaceEstimate {
 public:
  SurfaceEstimate(double inverse_depth, const Eigen::Vector2d& gradient)
      : inverse_depth_(inverse_depth), gradient_(gradient) {}

  double inverse_depth() const { return inverse_depth_; }        ///< 1/s; 0: unknown
  const Eigen::Vector2d& gradient() const { return gradient_; }  ///< of the inverse depth, 1/(px s)

  /// Averages over the last frames of a feature that is `frames` old. `predicted`: from the estimate so far, 1/s.
  void UpdateInverseDepth(double predicted, double measured, int frames);
  /// Replaces the gradient by one that neighbouring features tell.
  void SetGradient(const Eigen::Vector2d& gradient) { gradient_ = gradient; }
  /// Moves the gradient towards one that differs by `correction`, as the patch's own change of shape tells. Limits its
  /// size for a feature of this flow (px/s).
  void CorrectGradient(const Eigen::Vector2d& correction, double flow_px_s);

 private:
  double inverse_depth_;
  Eigen::Vector2d gradient_;
};

/// The window of events that a feature's position comes from.
struct FeatureWindow {
  TimeNs half = 0;                ///< half of its length
  Eigen::Vector2d measured_flow;  ///< px/s, by its events alone
};

/// How well the template has explained the events of the last windows, against noise.
class TemplateEvidence {
 public:
  /// Adds a window. `log_likelihood_ratio`: see MeanLogLikelihoodRatio.
  void Add(double log_likelihood_ratio);
  /// Whether the mean is at least `min_log_likelihood_ratio`, nats an event; true before the first window.
  bool IsEnough(double min_log_likelihood_ratio) const { return windows_ == 0 || mean_ >= min_log_likelihood_ratio; }

 private:
  int windows_ = 0;
  double mean_ = 0.0;  // over the last windows, nats an event
};

/// A live feature.
struct TrackedFeature {
  std::int64_t id = 0;
  int frames = 1;  ///< in which it was tracked so far
  FeatureState state;
  FeatureWindow window;
  SurfaceEstimate surface;
  FeatureTemplate event_template;
  OutlierEvidence outlier_evidence = {};
  TemplateEvidence template_evidence = {};
};

std::vector<FlowSample> FlowSamples(const std::vector<TrackedFeature>& features);
std::vector<DepthSample> DepthSamples(const std::vector<TrackedFeature>& features);

}  // namespace evo::tracking
