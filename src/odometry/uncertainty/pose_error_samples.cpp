#include "odometry/uncertainty/pose_error_samples.hpp"

#include <cmath>
#include <utility>

namespace evo::odometry {

PoseErrorSamples::PoseErrorSamples(std::vector<geometry::SE3> T_cam_world, Eigen::Index samples)
    : T_cam_world_(std::move(T_cam_world)), twists_(Eigen::MatrixXd::Zero(Row(T_cam_world_.size()), samples)) {}

Eigen::Vector3d PoseErrorSamples::CentreError(std::size_t pose, Eigen::Index sample) const {
  return -(T_cam_world_[pose].RotationMatrix().transpose() * twists_.block<3, 1>(Row(pose), sample));
}

void PoseErrorSamples::SetCentreError(std::size_t pose, Eigen::Index sample, const Eigen::Vector3d& error) {
  twists_.block<3, 1>(Row(pose), sample) = -(T_cam_world_[pose].RotationMatrix() * error);
}

void PoseErrorSamples::KeepRange(PoseRange range) {
  twists_ = twists_.middleRows(Row(range.begin), Row(range.end - range.begin)).eval();
  T_cam_world_ = {T_cam_world_.begin() + static_cast<std::ptrdiff_t>(range.begin),
                  T_cam_world_.begin() + static_cast<std::ptrdiff_t>(range.end)};
}

PoseErrorSamples::Twists PoseErrorSamples::RelativeTwists(std::size_t pose, std::size_t origin) const {
  return twists(pose) - geometry::Adjoint(T_cam_world_[pose] * T_cam_world_[origin].Inverse()) * twists(origin);
}

std::vector<geometry::Matrix6d> PoseErrorSamples::Covariances(std::size_t origin, bool scale_is_free) const {
  const auto centres = CameraCentres(T_cam_world_);
  const auto from_origin = [&](std::size_t i) -> Eigen::Vector3d {
    return T_cam_world_[i].RotationMatrix() * (centres[i] - centres[origin]);
  };
  Eigen::RowVectorXd scale_errors = Eigen::RowVectorXd::Zero(samples());  // relative, of the least-squares scale
  if (scale_is_free) {
    double squares = 0.0;
    for (std::size_t i = 0; i < poses(); ++i) {
      scale_errors -= from_origin(i).transpose() * RelativeTwists(i, origin).topRows<3>();
      squares += (centres[i] - centres[origin]).squaredNorm();
    }
    scale_errors /= squares > 0.0 ? squares : 1.0;
  }
  std::vector<geometry::Matrix6d> covariances;
  for (std::size_t i = 0; i < poses(); ++i) {
    Twists relative = RelativeTwists(i, origin);
    if (scale_is_free) relative.topRows<3>() += from_origin(i) * scale_errors;
    covariances.emplace_back(relative * relative.transpose() / static_cast<double>(samples()));
  }
  return covariances;
}

double PoseErrorSamples::RotationSigma(std::size_t from, std::size_t to) const {
  return RelativeTwists(to, from).bottomRows<3>().norm() / std::sqrt(static_cast<double>(samples()));
}

std::vector<Eigen::Vector3d> CameraCentres(const std::vector<geometry::SE3>& T_cam_world) {
  std::vector<Eigen::Vector3d> centres;
  for (const geometry::SE3& pose : T_cam_world) centres.push_back(pose.Inverse().translation());
  return centres;
}

}  // namespace evo::odometry
