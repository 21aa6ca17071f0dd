#include "odometry/bundle/pose_completer.hpp"

#include <cmath>

#include "evo/core/median.hpp"

namespace evo::odometry {

namespace {

constexpr double kMaxUncertaintyRatio = 3.0;  // standard deviation of a rotation over the typical one

/// Standard deviation of the camera's rotation relative to the points, rad.
double RotationSigma(const PoseEstimate& estimate) {
  return std::sqrt(estimate.covariance.bottomRightCorner<3, 3>().trace());
}

}  // namespace

void PoseCompleter::AddAdjusted(int frame, const geometry::SE3& T_cam_world) {
  const PoseEstimate estimate = points_.EstimatePose(frames_, frame, T_cam_world);
  poses_[frame] = {{frame, T_cam_world, estimate.inlier_count}, geometry::Matrix6d::Zero(), true};
  if (estimate.inlier_count > 0) rotation_sigmas_.push_back(RotationSigma(estimate));
}

bool PoseCompleter::AddEstimated(int frame, const geometry::SE3& T_cam_world_initial, double min_inlier_ratio) {
  const PoseEstimate estimate = points_.EstimatePose(frames_, frame, T_cam_world_initial);
  if (!points_.Accepts(estimate, min_inlier_ratio)) return false;
  poses_[frame] = {{frame, estimate.T_cam_world, estimate.inlier_count}, variance_inflation_ * estimate.covariance};
  rotation_sigmas_.push_back(RotationSigma(estimate));
  return true;
}

void PoseCompleter::Extend(int frame, int end, int direction, geometry::SE3 T_cam_world_initial) {
  const double typical_sigma = Median(rotation_sigmas_);
  for (; frame != end; frame += direction) {
    if (!AddEstimated(frame, T_cam_world_initial, PoseOptions().min_inlier_ratio)) return;
    if (rotation_sigmas_.back() > kMaxUncertaintyRatio * typical_sigma) {
      poses_.erase(frame);
      return;
    }
    T_cam_world_initial = poses_.at(frame).pose.T_cam_world;
  }
}

std::vector<SegmentPose> PoseCompleter::Poses() const {
  std::vector<SegmentPose> poses;
  for (const auto& [frame, pose] : poses_) poses.push_back(pose.pose);
  return poses;
}

std::vector<std::size_t> PoseCompleter::AdjustedPoses() const {
  std::vector<std::size_t> indices;
  std::size_t index = 0;
  for (const auto& [frame, pose] : poses_) {
    if (pose.is_adjusted) indices.push_back(index);
    ++index;
  }
  return indices;
}

std::vector<geometry::Matrix6d> PoseCompleter::Covariances() const {
  std::vector<geometry::Matrix6d> covariances;
  for (const auto& [frame, pose] : poses_) covariances.push_back(pose.covariance);
  return covariances;
}

}  // namespace evo::odometry
