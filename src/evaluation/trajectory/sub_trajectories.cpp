#include "evaluation/trajectory/sub_trajectories.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

namespace evo::evaluation {

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kLengthTolerance = 0.2;  // of rpg_trajectory_evaluation

/// Finds the ends of sub-trajectories of one length. Starts move forward, so each search continues from the last end.
class EndSearch {
 public:
  EndSearch(std::span<const double> distance, double length) : distance_(distance), length_(length) {}

  std::optional<std::size_t> Find(std::size_t first) {
    const double target = distance_[first] + length_;
    while (beyond_ < distance_.size() && distance_[beyond_] < target) ++beyond_;
    const bool reached = beyond_ < distance_.size();
    const double before = distance_[beyond_ - 1];  // the start itself lies before the target
    std::size_t end = beyond_;
    if (!reached || target - before <= distance_[beyond_] - target) {
      // Of the poses at which the truth stands still, the first.
      end = static_cast<std::size_t>(std::ranges::lower_bound(distance_, before) - distance_.begin());
    }
    if (std::abs(distance_[end] - target) >= kLengthTolerance * length_) return std::nullopt;
    return end;
  }

 private:
  std::span<const double> distance_;
  double length_;
  std::size_t beyond_ = 0;  // first pose at the target or farther
};

struct YawAndGravity {
  double yaw = 0.0;
  double gravity = 0.0;
};

/// Angles of R = Rz(yaw) Ry(pitch) Rx(roll) (rad).
YawAndGravity SplitYawAndGravity(const Eigen::Matrix3d& R) {
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  const double roll = std::atan2(R(2, 1), R(2, 2));
  return {std::abs(std::atan2(R(1, 0), R(0, 0))), std::hypot(pitch, roll)};
}

Statistics Scale(Statistics statistics, double factor) {
  for (double* value : {&statistics.rmse, &statistics.mean, &statistics.median, &statistics.standard_deviation,
                        &statistics.min, &statistics.max}) {
    *value *= factor;
  }
  statistics.sse *= factor * factor;
  return statistics;
}

}  // namespace

std::vector<SubTrajectoryErrors> ComputeSubTrajectoryErrors(const MatchedTrajectory& trajectory,
                                                            std::span<const double> lengths_m,
                                                            const Eigen::Vector3d& up) {
  const auto to_z = Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ());
  std::vector<SubTrajectoryErrors> results;
  for (const double length : lengths_m) {
    EndSearch ends(trajectory.distance, length);
    std::vector<double> translations, rotations, yaws, gravities;
    for (std::size_t first = 0; first < trajectory.size(); ++first) {
      const auto last = ends.Find(first);
      if (!last) continue;
      const Eigen::Quaterniond rotation = trajectory.RotationError(first, *last);
      const auto [yaw, gravity] = SplitYawAndGravity((to_z * rotation * to_z.conjugate()).toRotationMatrix());
      translations.push_back(trajectory.TranslationError(first, *last));
      rotations.push_back(kDegrees * RotationAngle(rotation));
      yaws.push_back(kDegrees * yaw);
      gravities.push_back(kDegrees * gravity);
    }
    if (translations.empty()) continue;
    const Statistics translation = ComputeStatistics(translations);
    const Statistics rotation = ComputeStatistics(rotations);
    results.push_back({length, translation, Scale(translation, 100.0 / length), rotation, Scale(rotation, 1.0 / length),
                       ComputeStatistics(yaws), ComputeStatistics(gravities)});
  }
  return results;
}

}  // namespace evo::evaluation
