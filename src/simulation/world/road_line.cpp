#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "evo/core/error.hpp"
#include "evo/simulation/motion.hpp"
#include "simulation/motion/smooth.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x726F6164;  // "road"

constexpr double kNodeSpacing = 0.125;  // m; cubic interpolation between is exact to less than a micrometre
constexpr double kLongest = 100'000.0;
constexpr double kSteepest = 0.3;

constexpr int kTurns = 4;
constexpr double kTurnRadius = 8.0;
constexpr double kTurnClothoid = 6.0;
constexpr double kAfterTurn = 10.0;  // the road ends no earlier than this after a turn

constexpr double kLeadIn = 15.0;  // straight before the first bend
constexpr double kTightest = 60.0;
constexpr double kWidest = 300.0;
constexpr double kLongestBend = 120.0;
constexpr double kLargestHeading = 1.0;  // rad; so that the road cannot come back to itself

constexpr double kLevelStart = 10.0;  // hills grow to their size from here
constexpr double kHillsFrom = 50.0;
constexpr std::array<double, 3> kHillShares = {0.5, 0.3, 0.2};

Eigen::Vector3d Tangent(const RoadLine::Point& point) {
  return {std::cos(point.pitch) * std::sin(point.heading), -std::sin(point.pitch),
          std::cos(point.pitch) * std::cos(point.heading)};
}

}  // namespace

RoadLine::RoadLine(const std::string& shape, double length_m, double slope, std::uint64_t seed) : length_(length_m) {
  if (!(length_m > 0.0 && length_m <= kLongest)) {
    throw Error(ErrorKind::kConfiguration, "a road's length must be above 0 and at most 100 km");
  }
  if (!(slope >= 0.0 && slope <= kSteepest)) {
    throw Error(ErrorKind::kConfiguration, "a road's slope must be in [0, 0.3]");
  }
  Random random(seed, kStream);
  if (shape == "straight") {
    Append(length_m, 0.0, 0.0);
    LayCrossings(&random);
  } else if (shape == "curved") {
    LayCurves(&random);
  } else if (shape == "turns") {
    LayTurns(&random);
  } else {
    throw Error(ErrorKind::kConfiguration,
                "unknown shape of a road '" + shape + "'; there are straight, curved and turns");
  }
  if (slope > 0.0) LayHills(slope, &random);
  Integrate();
}

void RoadLine::Append(double length, double curvature_start, double curvature_end) {
  Piece piece{0.0, length, curvature_start, curvature_end, 0.0};
  if (!pieces_.empty()) {
    const Piece& last = pieces_.back();
    piece.start = last.start + last.length;
    piece.heading_start = last.heading_start + 0.5 * (last.curvature_start + last.curvature_end) * last.length;
  }
  pieces_.push_back(piece);
}

void RoadLine::AppendBend(double angle, double radius, double clothoid) {
  const double curvature = std::copysign(1.0 / radius, angle);
  Append(clothoid, 0.0, curvature);
  Append(std::abs(angle) * radius - clothoid, curvature, curvature);
  Append(clothoid, curvature, 0.0);
}

void RoadLine::LayCurves(Random* random) {
  Append(kLeadIn, 0.0, 0.0);
  double heading = 0.0;
  while (end() < length_) {
    const double radius = kTightest * std::pow(kWidest / kTightest, random->Uniform());
    double angle = std::min(random->Uniform(0.3, 0.8), kLongestBend / radius);
    if (random->Chance(0.5)) angle = -angle;
    if (std::abs(heading + angle) > kLargestHeading) angle = -angle;
    heading += angle;
    AppendBend(angle, radius, 0.25 * radius);
    const double straight = random->Uniform(20.0, 60.0);
    const double middle = end() + 0.5 * straight;
    Append(straight, 0.0, 0.0);
    if (middle <= length_ && random->Chance(0.6)) crossings_.push_back(middle);
  }
}

void RoadLine::LayTurns(Random* random) {
  const double turn_length = 0.5 * std::numbers::pi * kTurnRadius + kTurnClothoid;
  double side = 0.0;
  double middle = random->Uniform(35.0, 45.0);
  for (int i = 0; i < kTurns && middle + 0.5 * turn_length + kAfterTurn <= length_; ++i) {
    Append(middle - 0.5 * turn_length - (pieces_.empty() ? 0.0 : end()), 0.0, 0.0);
    // Every second turn undoes the one before: the road never turns back on itself.
    const bool undo = i % 2 == 1;
    side = undo ? -side : (random->Chance(0.5) ? 1.0 : -1.0);
    AppendBend(side * 0.5 * std::numbers::pi, kTurnRadius, kTurnClothoid);
    crossings_.push_back(middle);
    middle += random->Uniform(75.0, 85.0);
  }
  Append(length_ - (pieces_.empty() ? 0.0 : end()), 0.0, 0.0);
}

void RoadLine::LayCrossings(Random* random) {
  for (double at = random->Uniform(40.0, 80.0); at <= length_; at += random->Uniform(80.0, 120.0)) {
    crossings_.push_back(at);
  }
}

void RoadLine::LayHills(double slope, Random* random) {
  for (const double share : kHillShares) {
    hills_.push_back({2.0 * std::numbers::pi / random->Uniform(80.0, 250.0), 2.0 * std::numbers::pi * random->Uniform(),
                      share * slope});
  }
}

void RoadLine::Integrate() {
  // Gauss and Legendre's three points on [0, 1].
  const double offset = 0.5 * std::sqrt(0.6);
  const int cells = static_cast<int>(std::ceil(end() / kNodeSpacing));
  node_spacing_ = end() / cells;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int i = 0; i <= cells; ++i) {
    const double s = i * node_spacing_;
    nodes_.push_back({position, Tangent(Direction(s))});
    const auto tangent = [&](double u) { return Tangent(Direction(s + u * node_spacing_)); };
    position += node_spacing_ / 18.0 * (5.0 * tangent(0.5 - offset) + 8.0 * tangent(0.5) + 5.0 * tangent(0.5 + offset));
  }
}

RoadLine::Point RoadLine::Direction(double distance) const {
  const double s = std::clamp(distance, 0.0, end());
  const Piece& piece = *(std::ranges::upper_bound(pieces_.begin() + 1, pieces_.end(), s, {}, &Piece::start) - 1);
  const double u = s - piece.start;
  const double rate = piece.length > 0.0 ? (piece.curvature_end - piece.curvature_start) / piece.length : 0.0;
  Point point;
  point.curvature = piece.curvature_start + rate * u;
  point.heading = piece.heading_start + u * (piece.curvature_start + 0.5 * rate * u);
  double slope = 0.0;
  for (const Wave& wave : hills_) slope += wave.slope * std::sin(wave.wavenumber * s + wave.phase);
  point.pitch = std::atan(slope * SmoothStep((s - kLevelStart) / (kHillsFrom - kLevelStart)));
  return point;
}

RoadLine::Point RoadLine::At(double distance_m) const {
  Point point = Direction(distance_m);
  const double s = std::clamp(distance_m, 0.0, end());
  const int i = std::min(static_cast<int>(s / node_spacing_), static_cast<int>(nodes_.size()) - 2);
  const Node& a = nodes_[i];
  const Node& b = nodes_[i + 1];
  const double u = s / node_spacing_ - i;
  const double v = 1.0 - u;
  point.position = v * v * ((1.0 + 2.0 * u) * a.position + u * node_spacing_ * a.tangent) +
                   u * u * ((1.0 + 2.0 * v) * b.position - v * node_spacing_ * b.tangent);
  if (distance_m < s) point.position += (distance_m - s) * nodes_.front().tangent;
  if (distance_m > s) point.position += (distance_m - s) * nodes_.back().tangent;
  return point;
}

}  // namespace evo::simulation
