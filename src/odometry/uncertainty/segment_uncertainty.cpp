#include "odometry/uncertainty/segment_uncertainty.hpp"

#include <utility>

namespace evo::odometry {

SegmentUncertainty::SegmentUncertainty(PoseErrorSamples adjusted_errors, std::vector<std::size_t> adjusted_poses,
                                       std::vector<geometry::Matrix6d> own_covariances)
    : adjusted_errors_(std::move(adjusted_errors)),
      adjusted_poses_(std::move(adjusted_poses)),
      own_covariances_(std::move(own_covariances)) {}

std::vector<geometry::Matrix6d> SegmentUncertainty::Covariances(bool scale_is_free) const {
  std::vector<geometry::Matrix6d> covariances;
  if (!adjusted_errors_) return covariances;
  const auto adjusted_covariances = adjusted_errors_->Covariances(0, scale_is_free);
  std::size_t k = 0;  // the last adjusted pose so far
  for (std::size_t i = 0; i < own_covariances_.size(); ++i) {
    while (k + 1 < adjusted_poses_.size() && adjusted_poses_[k + 1] <= i) ++k;
    covariances.push_back(adjusted_covariances[k] + own_covariances_[i]);
  }
  return covariances;
}

double SegmentUncertainty::ScaleDrift(double window) const {
  return adjusted_errors_ ? EstimateScaleDrift(*adjusted_errors_, window) : 0.0;
}

void SegmentUncertainty::ApplyScale(const ScaleInformation& information, const std::vector<double>& scales,
                                    const std::vector<geometry::SE3>& T_cam_world) {
  if (!adjusted_errors_) return;
  for (std::size_t i = 0; i < own_covariances_.size(); ++i) {
    own_covariances_[i].topRows<3>() *= scales[i];
    own_covariances_[i].leftCols<3>() *= scales[i];
  }
  std::vector<geometry::SE3> adjusted;
  for (const std::size_t i : adjusted_poses_) adjusted.push_back(T_cam_world[i]);
  ApplyScaleInformation(information, std::move(adjusted), &*adjusted_errors_);
}

}  // namespace evo::odometry
