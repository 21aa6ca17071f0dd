#pragma once

#include <algorithm>
#include <cstdint>
#include <random>

#include "odometry/bundle/bundle_problem.hpp"

namespace evo::odometry::testing {

/// A camera that drives forward among points; true poses and points, noisy observations.
inline BundleProblem DriveBundle(int frames, int points, double noise_px, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> side(-0.6, 0.6), depth(5.0, 40.0);
  std::normal_distribution<double> normal(0.0, noise_px);
  BundleProblem problem;
  for (int i = 0; i < frames; ++i) {
    problem.T_cam_world.emplace_back(geometry::so3::Exp({0.001 * i, -0.01 * i, 0}),
                                     Eigen::Vector3d(0.02 * i, 0, -0.4 * i));
  }
  const Eigen::Matrix2d J_pixel_normalized = 226.0 * Eigen::Matrix2d::Identity();
  for (int p = 0; p < points; ++p) {
    const int first = p % (frames - 4);
    const double z = depth(random);
    const BundlePoint point{first, {side(random), side(random), 1.0 / z}};
    const int id = static_cast<int>(problem.points.size());
    problem.points.push_back(point);
    for (int i = first; i < std::min(frames, first + 8); ++i) {
      const Eigen::Vector3d q = problem.T_cam_world[i] * WorldPosition(problem, point);
      if (q.z() < 1.0) break;
      const Eigen::Vector2d noise(normal(random), normal(random));
      problem.observations.push_back({i, id, q.head<2>() / q.z() + noise / 226.0, J_pixel_normalized});
    }
  }
  return problem;
}

/// Adds to every track a random walk over its surface, by `step_px` from observation to observation.
inline void AddTrackDrift(double step_px, std::uint32_t seed, BundleProblem* problem) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, step_px / 226.0);
  Eigen::Vector2d drift = Eigen::Vector2d::Zero();
  int point = -1;
  for (auto& observation : problem->observations) {
    const BundlePoint& bundle_point = problem->points[observation.point];
    const geometry::SE3 T_cam_anchor =
        problem->T_cam_world[observation.frame] * problem->T_cam_world[bundle_point.anchor].Inverse();
    const double depth_ratio =
        (T_cam_anchor * (bundle_point.inverse_depth.head<2>().homogeneous() / bundle_point.inverse_depth.z())).z() *
        bundle_point.inverse_depth.z();
    if (observation.point != point) drift.setZero();
    point = observation.point;
    observation.x += drift / depth_ratio;
    drift += depth_ratio * Eigen::Vector2d(normal(random), normal(random));
  }
}

}  // namespace evo::odometry::testing
