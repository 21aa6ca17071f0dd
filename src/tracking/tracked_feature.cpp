#include "tracking/tracked_feature.hpp"

#include <algorithm>

namespace evo::tracking {

namespace {

constexpr double kDepthGain = 0.25;           // of one frame, after the first few
constexpr double kGradientGain = 0.1;         // of one frame: a change of shape is noisier than a flow
constexpr double kMaxGradientPerFlow = 1e-3;  // 1/px^2; a steeper plane is seen edge-on, or not a plane
constexpr double kEvidenceGain = 0.2;         // of one window

}  // namespace

void SurfaceEstimate::UpdateInverseDepth(double predicted, double measured, int frames) {
  const bool is_known = inverse_depth_ > 0.0;
  inverse_depth_ = is_known ? predicted + std::max(kDepthGain, 1.0 / frames) * (measured - predicted) : measured;
}

void SurfaceEstimate::CorrectGradient(const Eigen::Vector2d& correction, double flow_px_s) {
  gradient_ += kGradientGain * correction;
  const double max_norm = kMaxGradientPerFlow * flow_px_s;
  const double norm = gradient_.norm();
  if (norm > max_norm) gradient_ *= max_norm / norm;
}

void TemplateEvidence::Add(double log_likelihood_ratio) {
  mean_ += std::max(kEvidenceGain, 1.0 / ++windows_) * (log_likelihood_ratio - mean_);
}

std::vector<FlowSample> FlowSamples(const std::vector<TrackedFeature>& features) {
  std::vector<FlowSample> samples;
  for (const auto& feature : features) samples.push_back(feature.state.flow_sample());
  return samples;
}

std::vector<DepthSample> DepthSamples(const std::vector<TrackedFeature>& features) {
  std::vector<DepthSample> samples;
  for (const auto& feature : features) samples.push_back({feature.state.position, feature.surface.inverse_depth()});
  return samples;
}

}  // namespace evo::tracking
