#include "odometry/mapping/segment_alignment.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace evo::odometry {

namespace {

constexpr std::size_t kMinPoints = 6;      // twice what a similarity needs
constexpr int kRounds = 3;                 // of fits, each without the outliers of the one before
constexpr double kOutlierMedians = 3.0;    // residual over the median residual
constexpr double kMaxResidualRatio = 0.1;  // median residual over the points' spread; more: no common shape

}  // namespace

std::optional<Similarity> AlignByPoints(const std::vector<Point>& points,
                                        const std::unordered_map<std::int64_t, Eigen::Vector3d>& old_points) {
  std::vector<Eigen::Vector3d> from, to;
  for (const Point& point : points) {
    const auto found = old_points.find(point.track);
    if (found == old_points.end()) continue;
    from.push_back(point.position);
    to.push_back(found->second);
  }
  for (int round = 0; round < kRounds; ++round) {
    if (from.size() < kMinPoints) return std::nullopt;
    const auto count = static_cast<Eigen::Index>(from.size());
    const Eigen::Map<const Eigen::Matrix3Xd> a(from.front().data(), 3, count), b(to.front().data(), 3, count);
    const Eigen::Matrix4d transform = Eigen::umeyama(a, b, true);
    const double scale = transform.topLeftCorner<3, 1>().norm();
    const Eigen::Matrix3d rotation = transform.topLeftCorner<3, 3>() / scale;
    const Eigen::VectorXd residuals =
        ((transform.topLeftCorner<3, 3>() * a).colwise() + transform.topRightCorner<3, 1>() - b).colwise().norm();
    std::vector<double> sorted(residuals.begin(), residuals.end());
    std::ranges::sort(sorted);
    const double median = sorted[sorted.size() / 2];
    if (round == kRounds - 1) {
      const double spread = std::sqrt((b.colwise() - b.rowwise().mean()).colwise().squaredNorm().mean());
      if (!(scale > 0.0) || !(median < kMaxResidualRatio * spread)) return std::nullopt;
      return Similarity{scale, geometry::SE3(Eigen::Quaterniond(rotation), transform.topRightCorner<3, 1>())};
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (residuals[static_cast<Eigen::Index>(i)] > kOutlierMedians * median) continue;
      from[kept] = from[i];
      to[kept++] = to[i];
    }
    from.resize(kept);
    to.resize(kept);
  }
  return std::nullopt;
}

void Transform(const Similarity& similarity, Bootstrap* bootstrap) {
  for (Point& point : bootstrap->points)
    point.position = similarity.T_world_local * (similarity.scale * point.position);
  for (geometry::SE3& pose : bootstrap->T_cam_world) {
    pose = geometry::SE3(pose.rotation(), similarity.scale * pose.translation()) * similarity.T_world_local.Inverse();
  }
}

}  // namespace evo::odometry
