#include "odometry/bundle/reprojection.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace evo::odometry {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMaxMagnification = 10.0;  // keeps the drift of a point that passes close by finite

/// p_cam times rho.
Eigen::Vector3d ScaledPointInCamera(const geometry::SE3& T_cam_anchor, const Eigen::Vector3d& inverse_depth) {
  return T_cam_anchor.rotation() * inverse_depth.head<2>().homogeneous() +
         inverse_depth.z() * T_cam_anchor.translation();
}

/// Sets the error in px; false if the point is behind the camera.
bool ComputeError(const geometry::SE3& T_cam_anchor, const Eigen::Vector3d& inverse_depth,
                  const BundleObservation& observation, Eigen::Vector2d* error) {
  const Eigen::Vector3d p = ScaledPointInCamera(T_cam_anchor, inverse_depth);
  if (!(p.z() > 0.0)) return false;
  *error = observation.J_pixel_normalized * (observation.x - p.head<2>() / p.z());
  return true;
}

/// Calls visit(begin, errors) for every point in order; its observations begin at `begin`.
template <typename Visitor>
void ForEachTrack(const BundleProblem& problem, const Visitor& visit) {
  std::vector<Eigen::Vector2d> errors;
  const auto begin = FirstObservations(problem);
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    ComputeTrackErrors(problem, begin[p], begin[p + 1], &errors);
    visit(begin[p], errors);
  }
}

/// Applies `filter`, ComputeInnovations or EstimateDrift, to the errors of every track.
template <typename TrackFilter>
std::vector<Eigen::Vector2d> FilterErrors(const BundleProblem& problem, double drift_variance_ratio,
                                          const TrackFilter& filter) {
  std::vector<Eigen::Vector2d> filtered, all;
  const auto steps = WhiteningSteps(problem, drift_variance_ratio);
  ForEachTrack(problem, [&](std::size_t begin, const std::vector<Eigen::Vector2d>& errors) {
    filter(std::span(steps).subspan(begin, errors.size()), errors, &filtered);
    all.insert(all.end(), filtered.begin(), filtered.end());
  });
  return all;
}

}  // namespace

bool LinearizeReprojection(const geometry::SE3& T_cam_anchor, const Eigen::Vector3d& inverse_depth,
                           const BundleObservation& observation, LinearizedReprojection* linearized) {
  const Eigen::Vector3d p = ScaledPointInCamera(T_cam_anchor, inverse_depth);
  if (!(p.z() > 0.0)) return false;
  const Eigen::Vector2d projection = p.head<2>() / p.z();
  linearized->error = observation.J_pixel_normalized * (observation.x - projection);
  Eigen::Matrix<double, 2, 3> J_error_p;
  J_error_p << 1.0, 0.0, -projection.x(), 0.0, 1.0, -projection.y();
  J_error_p = observation.J_pixel_normalized * J_error_p / -p.z();
  linearized->J_error_pose.leftCols<3>() = inverse_depth.z() * J_error_p;
  linearized->J_error_pose.rightCols<3>().noalias() = -J_error_p * geometry::so3::Hat(p);
  linearized->J_error_point.leftCols<2>().noalias() = J_error_p * T_cam_anchor.RotationMatrix().leftCols<2>();
  linearized->J_error_point.col(2).noalias() = J_error_p * T_cam_anchor.translation();
  return true;
}

void ComputeTrackErrors(const BundleProblem& problem, std::size_t begin, std::size_t end,
                        std::vector<Eigen::Vector2d>* errors) {
  errors->assign(end - begin, Eigen::Vector2d::Constant(kInfinity));
  if (begin == end) return;
  const BundlePoint& point = problem.points[problem.observations[begin].point];
  const geometry::SE3 T_world_anchor = problem.T_cam_world[point.anchor].Inverse();
  for (std::size_t i = begin; i < end; ++i) {
    const auto& observation = problem.observations[i];
    const geometry::SE3 T_cam_anchor = problem.T_cam_world[observation.frame] * T_world_anchor;
    ComputeError(T_cam_anchor, point.inverse_depth, observation, &(*errors)[i - begin]);
  }
}

std::vector<Eigen::Vector2d> ReprojectionErrors(const BundleProblem& problem) {
  std::vector<Eigen::Vector2d> all;
  ForEachTrack(problem, [&](std::size_t, const std::vector<Eigen::Vector2d>& errors) {
    all.insert(all.end(), errors.begin(), errors.end());
  });
  return all;
}

std::vector<WhiteningStep> WhiteningSteps(const BundleProblem& problem, double drift_variance_ratio) {
  std::vector<WhiteningStep> steps;
  std::vector<double> magnifications;
  const auto begin = FirstObservations(problem);
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    magnifications.clear();
    const BundlePoint& point = problem.points[p];
    const geometry::SE3 T_world_anchor = problem.T_cam_world[point.anchor].Inverse();
    for (std::size_t i = begin[p]; i < begin[p + 1]; ++i) {
      const geometry::SE3 T_cam_anchor = problem.T_cam_world[problem.observations[i].frame] * T_world_anchor;
      const double depth_ratio = ScaledPointInCamera(T_cam_anchor, point.inverse_depth).z();  // over that in the anchor
      magnifications.push_back(1.0 / std::clamp(depth_ratio, 1.0 / kMaxMagnification, kMaxMagnification));
    }
    AppendWhiteningSteps(drift_variance_ratio, magnifications, &steps);
    for (std::size_t i = begin[p]; i < begin[p + 1]; ++i) steps[i].normalization *= point.weight;
  }
  return steps;
}

std::vector<Eigen::Vector2d> ReprojectionInnovations(const BundleProblem& problem, double drift_variance_ratio) {
  return FilterErrors(problem, drift_variance_ratio, ComputeInnovations);
}

std::vector<Eigen::Vector2d> ReprojectionDrifts(const BundleProblem& problem, double drift_variance_ratio) {
  return FilterErrors(problem, drift_variance_ratio, EstimateDrift);
}

}  // namespace evo::odometry
