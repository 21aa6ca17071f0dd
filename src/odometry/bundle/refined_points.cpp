#include "odometry/bundle/refined_points.hpp"

#include <algorithm>

#include "odometry/bundle/reprojection.hpp"
#include "odometry/bundle/track_weights.hpp"

namespace evo::odometry {

namespace {

constexpr int kMinInliers = 3;             // frames that agree with a point
constexpr double kMinInverseDepth = 1e-9;  // a point beyond is at infinity and has no position

}  // namespace

RefinedPoints::RefinedPoints(const SegmentBundle& bundle, double drift_variance_ratio, const Segment& segment) {
  const BundleProblem& problem = bundle.problem;
  std::vector<Point> points(problem.points.size());
  std::vector<Drifts> track_drifts(problem.points.size());
  const auto errors = ReprojectionErrors(problem);
  const auto drifts = ReprojectionDrifts(problem, drift_variance_ratio);
  const double sigma_px = EstimateNoise(errors);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const BundleObservation& observation = problem.observations[i];
    Point& point = points[observation.point];
    ++(errors[i].norm() < kOutlierSigmas * sigma_px ? point.inliers : point.outliers);
    track_drifts[observation.point].emplace_back(segment.poses[bundle.segment_poses[observation.frame]].frame,
                                                 observation.J_pixel_normalized.inverse() * drifts[i]);
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    const BundlePoint& refined = problem.points[p];
    if (points[p].inliers < kMinInliers || !(refined.inverse_depth.z() > kMinInverseDepth)) continue;
    points[p].track = bundle.track_ids[p];
    points[p].position = WorldPosition(problem, refined);
    pieces_[points[p].track].push_back({points[p].position, std::move(track_drifts[p])});
    points_.push_back(points[p]);
  }
}

PoseEstimate RefinedPoints::EstimatePose(const std::vector<Frame>& frames, int frame,
                                         const geometry::SE3& T_cam_world_initial) const {
  std::vector<PoseObservation> observations;
  for (const Feature& feature : frames[frame].features) {
    const auto found = pieces_.find(feature.track);
    if (found == pieces_.end()) continue;
    const auto first_frame = [](const Piece& piece) { return piece.drifts[0].first; };
    auto piece = std::ranges::upper_bound(found->second, frame, {}, first_frame);
    if (piece != found->second.begin()) --piece;
    observations.push_back({piece->position, feature.x - Drift(*piece, frame), feature.J_pixel_normalized});
  }
  return optimizer_.Optimize(observations, T_cam_world_initial);
}

Eigen::Vector2d RefinedPoints::Drift(const Piece& piece, int frame) {
  auto nearest = std::ranges::upper_bound(piece.drifts, frame, {}, &Drifts::value_type::first);
  if (nearest != piece.drifts.begin()) --nearest;
  return nearest->second;
}

}  // namespace evo::odometry
