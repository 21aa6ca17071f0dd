#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr double kTurnCurvature = 1.0 / 30.0;  // 1/m: between those of right-angle turns (1/8) and bends (1/60)
constexpr double kMaxTurnLength = 40.0;        // m on each side of a junction's centre
constexpr double kStep = 0.5;                  // m

}  // namespace

StreetPlan::StreetPlan(const ReferenceLine& road, const StreetOptions& options, double camera_height_m)
    : road_(road),
      layout_{options.road_width_m, options.parking_width_m, options.parked_cars_per_100_m > 0.0},
      pavement_(options.pavement_width_m),
      camera_height_(camera_height_m),
      own_side_(options.left_hand_traffic ? -1 : 1),
      own_lane_(-options.camera_lateral_m) {
  for (const double distance : road.junctions()) AddJunction(distance);
  MarkRoads();
}

Eigen::Vector3d StreetPlan::Right(double distance) const {
  const double heading = Heading(distance);
  return {std::cos(heading), 0.0, -std::sin(heading)};
}

Eigen::Vector3d StreetPlan::Forward(double distance) const { return ReferenceLine::Tangent(road_.PointAt(distance)); }

Eigen::Vector3d StreetPlan::PointAt(double distance, double lateral, double up) const {
  return road_.PointAt(distance).position + lateral * Right(distance) + Eigen::Vector3d(0.0, camera_height_ - up, 0.0);
}

void StreetPlan::AddJunction(double distance) {
  Junction junction;
  const double half = 0.5 * layout_.width();
  junction.from = distance - half;
  junction.to = distance + half;
  const auto turns_at = [&](double s) { return std::abs(Curvature(s)) > kTurnCurvature; };
  if (turns_at(distance)) {
    while (junction.from > distance - kMaxTurnLength && std::abs(Curvature(junction.from)) > 1e-6)
      junction.from -= kStep;
    while (junction.to < distance + kMaxTurnLength && std::abs(Curvature(junction.to)) > 1e-6) junction.to += kStep;
  }
  const double turn = Heading(junction.to) - Heading(junction.from);
  junction.forward = Forward(distance);
  junction.right = Right(distance);
  junction.centre = PointAt(distance, centre_line(), 0.0);
  if (std::abs(turn) > 0.2) {
    // Intersection of the centre lines before and after the turn.
    const Eigen::Vector3d in = Forward(junction.from);
    const Eigen::Vector3d to_exit =
        PointAt(junction.to, centre_line(), 0.0) - PointAt(junction.from, centre_line(), 0.0);
    const Eigen::Vector3d across = Right(junction.to);
    const double ahead = to_exit.dot(across) / in.dot(across);
    junction.centre = PointAt(junction.from, centre_line(), 0.0) + ahead * in;
    junction.centre.y() = PointAt(distance, centre_line(), 0.0).y();
  }
  const double mid_heading = Heading(distance);
  for (const double quarter : {-1.0, 0.0, 1.0}) {
    const double arm = quarter * 0.5 * std::numbers::pi;
    if (std::abs(arm - turn) < 0.5) continue;
    const double angle = Heading(junction.from) + arm - mid_heading;
    junction.arms.push_back(std::cos(angle) * junction.forward + std::sin(angle) * junction.right);
  }
  junctions_.push_back(junction);
}

void StreetPlan::MarkRoads() {
  constexpr double kTolerance = 0.3;  // m: straight facades along a bend
  const double radius = 0.5 * layout_.width() + pavement_ - kTolerance;
  const auto mark = [&](const Eigen::Vector3d& point) { occupied_.push_back({point.x(), point.z(), radius}); };
  for (double s = begin(); s < end(); s += 1.0) mark(PointAt(s, centre_line(), 0.0));
  for (const Junction& junction : junctions_) {
    for (const Eigen::Vector3d& arm : junction.arms) {
      for (double s = 0.0; s < kArmLength; s += 1.0) mark(junction.centre + s * arm);
    }
  }
}

bool StreetPlan::IsClearOfJunctions(double from, double to, double margin) const {
  return std::none_of(junctions_.begin(), junctions_.end(), [&](const Junction& junction) {
    return to > junction.from - margin && from < junction.to + margin;
  });
}

bool StreetPlan::IsFree(const std::vector<Eigen::Vector3d>& points) const {
  return std::none_of(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
    return std::any_of(occupied_.begin(), occupied_.end(), [&](const Circle& circle) {
      const double dx = point.x() - circle.x;
      const double dz = point.z() - circle.z;
      return dx * dx + dz * dz < circle.radius * circle.radius;
    });
  });
}

}  // namespace evo::simulation
