#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr double kTurning = 1.0 / 30.0;  // curvature of a right-angle turn, not of a bend
constexpr double kStep = 0.5;

}  // namespace

StreetPlan::StreetPlan(const RoadLine& road, const StreetOptions& options, double camera_height_m)
    : road_(road),
      layout_{options.road_width_m, options.parking_width_m, options.parked_cars_per_100_m > 0.0},
      pavement_(options.pavement_width_m),
      camera_height_(camera_height_m) {
  for (const double distance : road.crossings()) AddCrossing(distance);
  MarkRoads();
}

Eigen::Vector3d StreetPlan::Right(double distance) const {
  const double heading = Heading(distance);
  return {std::cos(heading), 0.0, -std::sin(heading)};
}

Eigen::Vector3d StreetPlan::Forward(double distance) const {
  const RoadLine::Point point = road_.At(distance);
  return {std::cos(point.pitch) * std::sin(point.heading), -std::sin(point.pitch),
          std::cos(point.pitch) * std::cos(point.heading)};
}

Eigen::Vector3d StreetPlan::At(double distance, double lateral, double up) const {
  return road_.At(distance).position + lateral * Right(distance) + Eigen::Vector3d(0.0, camera_height_ - up, 0.0);
}

void StreetPlan::AddCrossing(double distance) {
  Crossing crossing;
  const double half = 0.5 * layout_.width();
  crossing.from = distance - half;
  crossing.to = distance + half;
  const auto turns_at = [&](double s) { return std::abs(Curvature(s)) > kTurning; };
  if (turns_at(distance)) {
    while (crossing.from > distance - 40.0 && std::abs(Curvature(crossing.from)) > 1e-6) crossing.from -= kStep;
    while (crossing.to < distance + 40.0 && std::abs(Curvature(crossing.to)) > 1e-6) crossing.to += kStep;
  }
  const double turn = Heading(crossing.to) - Heading(crossing.from);
  crossing.forward = Forward(distance);
  crossing.right = Right(distance);
  crossing.centre = At(distance, middle(), 0.0);
  if (std::abs(turn) > 0.2) {
    // Where the middle of the road that comes meets that of the road that goes.
    const Eigen::Vector3d in = Forward(crossing.from);
    const Eigen::Vector3d to_exit = At(crossing.to, middle(), 0.0) - At(crossing.from, middle(), 0.0);
    const Eigen::Vector3d across = Right(crossing.to);
    const double ahead = to_exit.dot(across) / in.dot(across);
    crossing.centre = At(crossing.from, middle(), 0.0) + ahead * in;
    crossing.centre.y() = At(distance, middle(), 0.0).y();
  }
  const double mid_heading = Heading(distance);
  for (const double quarter : {-1.0, 0.0, 1.0}) {
    const double arm = quarter * 0.5 * std::numbers::pi;
    if (std::abs(arm - turn) < 0.5) continue;
    const double angle = Heading(crossing.from) + arm - mid_heading;
    crossing.arms.push_back(std::cos(angle) * crossing.forward + std::sin(angle) * crossing.right);
  }
  crossings_.push_back(crossing);
}

void StreetPlan::MarkRoads() {
  constexpr double kTolerance = 0.3;  // a straight front along a bend
  const double radius = 0.5 * layout_.width() + pavement_ - kTolerance;
  const auto mark = [&](const Eigen::Vector3d& point) { taken_.push_back({point.x(), point.z(), radius}); };
  for (double s = begin(); s < end(); s += 1.0) mark(At(s, middle(), 0.0));
  for (const Crossing& crossing : crossings_) {
    for (const Eigen::Vector3d& arm : crossing.arms) {
      for (double s = 0.0; s < kArmLength; s += 1.0) mark(crossing.centre + s * arm);
    }
  }
}

bool StreetPlan::IsClearOfCrossings(double from, double to, double margin) const {
  return std::none_of(crossings_.begin(), crossings_.end(), [&](const Crossing& crossing) {
    return to > crossing.from - margin && from < crossing.to + margin;
  });
}

bool StreetPlan::IsFree(const std::vector<Eigen::Vector3d>& points) const {
  return std::none_of(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
    return std::any_of(taken_.begin(), taken_.end(), [&](const Circle& circle) {
      const double dx = point.x() - circle.x;
      const double dz = point.z() - circle.z;
      return dx * dx + dz * dz < circle.radius * circle.radius;
    });
  });
}

}  // namespace evo::simulation
