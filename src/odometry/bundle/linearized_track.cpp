#include "odometry/bundle/linearized_track.hpp"

#include "evo/core/robust.hpp"

namespace evo::odometry {

void LinearizedTrack::Linearize(const BundleProblem& problem, const NoiseModel& noise, std::size_t begin,
                                std::size_t end) {
  const std::size_t count = end - begin;
  observations_.resize(count);
  errors_.resize(count);
  innovation_weights_.resize(count);
  if (count == 0) return;
  const BundlePoint& point = problem.points[problem.observations[begin].point];
  const geometry::SE3 T_world_anchor = problem.T_cam_world[point.anchor].Inverse();
  for (std::size_t k = 0; k < count; ++k) {
    const auto& observation = problem.observations[begin + k];
    const geometry::SE3 T_cam_anchor = problem.T_cam_world[observation.frame] * T_world_anchor;
    const bool visible = LinearizeReprojection(T_cam_anchor, point.inverse_depth, observation, &observations_[k]);
    if (!visible) observations_[k] = {};
    innovation_weights_[k] = visible ? 1.0 : 0.0;
    errors_[k] = observations_[k].error;
  }
  const auto whitening = noise.Whitening(begin, end);
  ComputeInnovations(whitening, errors_, &innovations_);
  const double squared_width = noise.cauchy_width_px * noise.cauchy_width_px;
  for (std::size_t k = 0; k < count; ++k) {
    innovation_weights_[k] *= CauchyWeight(innovations_[k].squaredNorm() / squared_width);
  }
  ComputeErrorInformation(whitening, innovation_weights_, &gradient_weights_);
  has_hessian_weights_ = noise.use_second_derivative;
  if (!has_hessian_weights_) return;
  // In two dimensions Cauchy's loss has the second derivatives w and w (2 w - 1), of mean w^2, for its weight w.
  for (double& weight : innovation_weights_) weight *= weight;
  ComputeErrorInformation(whitening, innovation_weights_, &hessian_weights_);
}

LinearizedTrack::WeightedRow LinearizedTrack::ComputeWeightedRow(std::size_t k) const {
  WeightedRow row;
  const auto column = static_cast<Eigen::Index>(k);
  const Eigen::MatrixXd& hessian_weights = HessianWeights();
  for (std::size_t l = 0; l < observations_.size(); ++l) {
    const auto other = static_cast<Eigen::Index>(l);
    const double gradient_weight = gradient_weights_(other, column);
    if (gradient_weight == 0.0) continue;
    row.error += gradient_weight * observations_[l].error;
    row.J_error_point += hessian_weights(other, column) * observations_[l].J_error_point;
  }
  return row;
}

}  // namespace evo::odometry
