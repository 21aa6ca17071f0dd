#include "evo/odometry/travel_direction.hpp"

#include <spdlog/spdlog.h>

#include <cmath>
#include <utility>

#include "odometry/median.hpp"

namespace evo {

namespace {

constexpr double kMedianToSigma = 0.8493;  // the norm of a 2-d unit Gaussian has the median 1.1774
constexpr int kIterations = 20;

/// Two axes across a direction, as rows.
Eigen::Matrix<double, 2, 3> Across(const Eigen::Vector3d& direction) {
  Eigen::Matrix<double, 2, 3> axes;
  axes.row(0) = direction.unitOrthogonal().transpose();
  axes.row(1) = direction.cross(axes.row(0).transpose()).transpose();
  return axes;
}

/// Motion of the camera in its own frame.
Vector6d Motion(const SE3& before, const SE3& after) { return -(after * before.Inverse()).Log(); }

}  // namespace

Eigen::Vector2d MeasureSideSlip(const TravelDirection& travel, const SE3& before, const SE3& after) {
  const Vector6d motion = Motion(before, after);
  const Eigen::Vector3d v = motion.head<3>();
  const double length = v.norm();
  if (!(length > 0.0)) return Eigen::Vector2d::Zero();
  return Across(travel.direction) * (v - travel.lever * motion.tail<3>().cross(travel.direction)) / length;
}

SideSlip LinearizeSideSlip(const TravelDirection& travel, const SE3& before, const SE3& after) {
  SideSlip slip;
  const Vector6d motion = Motion(before, after);
  const Eigen::Vector3d v = motion.head<3>();
  const double length = v.norm();
  if (!(length > 0.0)) return slip;
  const auto axes = Across(travel.direction);
  slip.value = axes * (v - travel.lever * motion.tail<3>().cross(travel.direction)) / length;
  Eigen::Matrix<double, 2, 6> by_motion;
  by_motion.leftCols<3>() = axes / length - slip.value * v.transpose() / (length * length);
  by_motion.rightCols<3>() = travel.lever / length * axes * so3::Hat(travel.direction);
  // Log(Exp(d) M) ~ Log(M) + (1 - ad / 2 + ad^2 / 12) d, and Log(M Exp(-d)) ~ Log(M) - (1 + ad / 2 + ad^2 / 12) d.
  Matrix6d ad = Matrix6d::Zero();
  ad.topLeftCorner<3, 3>() = ad.bottomRightCorner<3, 3>() = -so3::Hat(motion.tail<3>());
  ad.topRightCorner<3, 3>() = -so3::Hat(motion.head<3>());
  const Matrix6d second = Matrix6d::Identity() + ad * ad / 12.0;
  slip.by_after = -by_motion * (second - 0.5 * ad);
  slip.by_before = by_motion * (second + 0.5 * ad);
  return slip;
}

TravelDirection MeasureTravelDirection(const std::vector<SE3>& poses, double times, double sigma_px) {
  std::vector<Eigen::Vector3d> directions;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const Eigen::Vector3d v = Motion(poses[i], poses[i + 1]).head<3>();
    if (v.norm() > 0.0) directions.push_back(v.normalized());
  }
  TravelDirection travel;
  if (directions.empty()) return travel;
  // Geometric median on the sphere.
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& d : directions) sum += d;
  travel.direction = sum.normalized();
  for (int i = 0; i < kIterations; ++i) {
    sum.setZero();
    for (const auto& d : directions) sum += d / std::max(1e-4, (d - travel.direction).norm());
    travel.direction = sum.normalized();
  }
  if (getenv("TRUE_DIR")) travel.direction = Eigen::Vector3d::UnitZ();
  std::vector<double> slips;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i)
    slips.push_back(MeasureSideSlip(travel, poses[i], poses[i + 1]).norm());
  const double sigma = times * kMedianToSigma * Median(std::move(slips));
  if (sigma > 0.0) travel.px = sigma_px / sigma;
  spdlog::debug("odometry: travels along {:.4f} {:.4f} {:.4f}, side slip {:.3f} deg", travel.direction.x(),
                travel.direction.y(), travel.direction.z(), sigma / times * 57.2958);
  return travel;
}

}  // namespace evo
