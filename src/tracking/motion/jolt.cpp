#include "tracking/motion/jolt.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace evo::tracking {

namespace {

constexpr std::size_t kFewestFeatures = 12;
constexpr int kIterations = 5;
constexpr double kUsualOffsetPx = 1.0;   // beyond this
constexpr double kUsualFlowPxS = 20.0;   // and this a feature counts less and less
constexpr double kSmallestSquare = 1.0;  // px^2: features that hardly tell a turn about some axis tell none

Eigen::Vector3d CommonTurn(std::span<const UnexpectedMotion> motions, Eigen::Vector2d UnexpectedMotion::*part,
                           double usual) {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix3d normal = kSmallestSquare * Eigen::Matrix3d::Identity();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const auto& motion : motions) {
      const double left = (motion.*part - motion.by_rotation * turn).norm() / usual;
      const double weight = 1.0 / (1.0 + left * left);
      normal += weight * motion.by_rotation.transpose() * motion.by_rotation;
      right += weight * motion.by_rotation.transpose() * motion.*part;
    }
    turn = normal.ldlt().solve(right);
  }
  return turn;
}

}  // namespace

Jolt FindJolt(std::span<const UnexpectedMotion> motions) {
  if (motions.size() < kFewestFeatures) return {};
  Jolt jolt{.turn = CommonTurn(motions, &UnexpectedMotion::offset, kUsualOffsetPx),
            .turn_rate = CommonTurn(motions, &UnexpectedMotion::flow, kUsualFlowPxS)};
  double squares = 0.0;
  for (const auto& motion : motions) squares += (motion.by_rotation * jolt.turn).squaredNorm();
  jolt.motion_px = std::sqrt(squares / static_cast<double>(motions.size()));
  return jolt;
}

}  // namespace evo::tracking
