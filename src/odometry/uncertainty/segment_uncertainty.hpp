#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "odometry/uncertainty/pose_error_samples.hpp"
#include "odometry/uncertainty/scale_information.hpp"

namespace evo::odometry {

/// The uncertainty of all poses of a segment: jointly that of the adjusted ones, and for every pose its own covariance
/// besides that of the last adjusted pose before it, or of the first. All covariances are of left twists of
/// T_cam_world.
class SegmentUncertainty {
 public:
  /// Nothing is known.
  SegmentUncertainty() = default;
  /// `adjusted_poses` are the indices of the adjusted poses in the segment, at least one; `own_covariances` are those
  /// of all poses.
  SegmentUncertainty(PoseErrorSamples adjusted_errors, std::vector<std::size_t> adjusted_poses,
                     std::vector<geometry::Matrix6d> own_covariances);

  /// Covariances of all poses relative to the first adjusted one, see PoseErrorSamples; empty if nothing is known.
  std::vector<geometry::Matrix6d> Covariances(bool scale_is_free) const;

  /// See EstimateScaleDrift; 0 if nothing is known.
  double ScaleDrift(double window) const;

  /// After every pose got its scale `scales`; `T_cam_world` are all poses with it, of the same rotations.
  void ApplyScale(const ScaleInformation& information, const std::vector<double>& scales,
                  const std::vector<geometry::SE3>& T_cam_world);

 private:
  std::optional<PoseErrorSamples> adjusted_errors_;
  std::vector<std::size_t> adjusted_poses_;
  std::vector<geometry::Matrix6d> own_covariances_;
};

}  // namespace evo::odometry
