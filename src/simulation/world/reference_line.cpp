#include "simulation/world/reference_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "evo/core/error.hpp"
#include "simulation/smoother_step.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x726F6164;  // "road"

constexpr double kNodeSpacing = 0.125;    // m: the cubic interpolation is exact to less than a micrometre
constexpr double kMaxLength = 100'000.0;  // m: the nodes take 40 MB
constexpr double kMaxSlope = 0.3;         // the steepest streets there are have 0.35

// "turns": a city block's right angles.
constexpr int kTurns = 4;
constexpr double kTurnRadius = 8.0;    // m
constexpr double kTurnClothoid = 6.0;  // m
constexpr double kAfterTurn = 10.0;    // m of road at least after a turn

// "curved": a country road's bends.
constexpr double kLeadIn = 15.0;          // m of straight road before the first bend
constexpr double kMinRadius = 60.0;       // m
constexpr double kMaxRadius = 300.0;      // m
constexpr double kMaxBendLength = 120.0;  // m
constexpr double kMaxHeading = 1.0;       // rad: the road cannot come back to itself

constexpr double kHillsStart = 10.0;  // m: hills grow from here, so that the run starts level,
constexpr double kHillsFull = 50.0;   // m: to their full slope here
constexpr std::array<double, 3> kHillSlopeRatios = {0.5, 0.3, 0.2};  // of three sines; the sum is 1

}  // namespace

ReferenceLine::ReferenceLine(const std::string& shape, double length_m, double slope, std::uint64_t seed)
    : length_(length_m) {
  if (!(length_m > 0.0 && length_m <= kMaxLength)) {
    throw Error(ErrorKind::kConfiguration, "a road's length must be above 0 and at most 100 km");
  }
  if (!(slope >= 0.0 && slope <= kMaxSlope)) {
    throw Error(ErrorKind::kConfiguration, "a road's slope must be in [0, 0.3]");
  }
  Random random(seed, kStream);
  if (shape == "straight") {
    Append(length_m, 0.0, 0.0);
    AddJunctions(&random);
  } else if (shape == "curved") {
    AddCurves(&random);
  } else if (shape == "turns") {
    AddTurns(&random);
  } else {
    throw Error(ErrorKind::kConfiguration, "unknown shape of a road '" + shape + "'; choose straight, curved or turns");
  }
  if (slope > 0.0) AddHills(slope, &random);
  IntegratePosition();
}

Eigen::Vector3d ReferenceLine::Tangent(const Point& point) {
  return {std::cos(point.pitch) * std::sin(point.heading), -std::sin(point.pitch),
          std::cos(point.pitch) * std::cos(point.heading)};
}

void ReferenceLine::Append(double length, double curvature_start, double curvature_end) {
  Segment segment{0.0, length, curvature_start, curvature_end, 0.0};
  if (!segments_.empty()) {
    const Segment& last = segments_.back();
    segment.start = last.start + last.length;
    segment.heading_start = last.heading_start + 0.5 * (last.curvature_start + last.curvature_end) * last.length;
  }
  segments_.push_back(segment);
}

void ReferenceLine::AppendBend(double angle, double radius, double clothoid) {
  const double curvature = std::copysign(1.0 / radius, angle);
  Append(clothoid, 0.0, curvature);
  Append(std::abs(angle) * radius - clothoid, curvature, curvature);
  Append(clothoid, curvature, 0.0);
}

void ReferenceLine::AddCurves(Random* random) {
  Append(kLeadIn, 0.0, 0.0);
  double heading = 0.0;
  while (end() < length_) {
    const double radius = kMinRadius * std::pow(kMaxRadius / kMinRadius, random->Uniform());
    double angle = std::min(random->Uniform(0.3, 0.8), kMaxBendLength / radius);
    if (random->Chance(0.5)) angle = -angle;
    if (std::abs(heading + angle) > kMaxHeading) angle = -angle;
    heading += angle;
    AppendBend(angle, radius, 0.25 * radius);
    const double straight = random->Uniform(20.0, 60.0);
    const double middle = end() + 0.5 * straight;
    Append(straight, 0.0, 0.0);
    if (middle <= length_ && random->Chance(0.6)) junctions_.push_back(middle);
  }
}

void ReferenceLine::AddTurns(Random* random) {
  const double turn_length = 0.5 * std::numbers::pi * kTurnRadius + kTurnClothoid;
  double side = 0.0;
  double middle = random->Uniform(35.0, 45.0);
  for (int i = 0; i < kTurns && middle + 0.5 * turn_length + kAfterTurn <= length_; ++i) {
    Append(middle - 0.5 * turn_length - (segments_.empty() ? 0.0 : end()), 0.0, 0.0);
    // Every second turn reverses the one before, so that the road never meets itself.
    const bool reverses = i % 2 == 1;
    side = reverses ? -side : (random->Chance(0.5) ? 1.0 : -1.0);
    AppendBend(side * 0.5 * std::numbers::pi, kTurnRadius, kTurnClothoid);
    junctions_.push_back(middle);
    middle += random->Uniform(75.0, 85.0);
  }
  Append(length_ - (segments_.empty() ? 0.0 : end()), 0.0, 0.0);
}

void ReferenceLine::AddJunctions(Random* random) {
  for (double at = random->Uniform(40.0, 80.0); at <= length_; at += random->Uniform(80.0, 120.0)) {
    junctions_.push_back(at);
  }
}

void ReferenceLine::AddHills(double slope, Random* random) {
  for (const double ratio : kHillSlopeRatios) {
    hills_.push_back({2.0 * std::numbers::pi / random->Uniform(80.0, 250.0), 2.0 * std::numbers::pi * random->Uniform(),
                      ratio * slope});
  }
}

void ReferenceLine::IntegratePosition() {
  // Gauss-Legendre quadrature with three points on [0, 1].
  const double offset = 0.5 * std::sqrt(0.6);
  const int cells = static_cast<int>(std::ceil(end() / kNodeSpacing));
  node_spacing_ = end() / cells;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int i = 0; i <= cells; ++i) {
    const double s = i * node_spacing_;
    nodes_.push_back({position, Tangent(DirectionAt(s))});
    const auto tangent = [&](double u) { return Tangent(DirectionAt(s + u * node_spacing_)); };
    position += node_spacing_ / 18.0 * (5.0 * tangent(0.5 - offset) + 8.0 * tangent(0.5) + 5.0 * tangent(0.5 + offset));
  }
}

ReferenceLine::Point ReferenceLine::DirectionAt(double distance) const {
  const double s = std::clamp(distance, 0.0, end());
  const Segment& segment =
      *(std::ranges::upper_bound(segments_.begin() + 1, segments_.end(), s, {}, &Segment::start) - 1);
  const double u = s - segment.start;
  const double rate = segment.length > 0.0 ? (segment.curvature_end - segment.curvature_start) / segment.length : 0.0;
  Point point;
  point.curvature = segment.curvature_start + rate * u;
  point.heading = segment.heading_start + u * (segment.curvature_start + 0.5 * rate * u);
  double slope = 0.0;
  for (const Wave& wave : hills_) slope += wave.slope * std::sin(wave.wavenumber * s + wave.phase);
  point.pitch = std::atan(slope * SmootherStep((s - kHillsStart) / (kHillsFull - kHillsStart)));
  return point;
}

ReferenceLine::Point ReferenceLine::PointAt(double distance_m) const {
  Point point = DirectionAt(distance_m);
  const double s = std::clamp(distance_m, 0.0, end());
  const int i = std::min(static_cast<int>(s / node_spacing_), static_cast<int>(nodes_.size()) - 2);
  const Node& a = nodes_[i];
  const Node& b = nodes_[i + 1];
  const double u = s / node_spacing_ - i;
  const double v = 1.0 - u;
  // Cubic Hermite interpolation.
  point.position = v * v * ((1.0 + 2.0 * u) * a.position + u * node_spacing_ * a.tangent) +
                   u * u * ((1.0 + 2.0 * v) * b.position - v * node_spacing_ * b.tangent);
  if (distance_m < s) point.position += (distance_m - s) * nodes_.front().tangent;
  if (distance_m > s) point.position += (distance_m - s) * nodes_.back().tangent;
  return point;
}

}  // namespace evo::simulation
