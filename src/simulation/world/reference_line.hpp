#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "evo/core/random.hpp"

namespace evo::simulation {

/// The reference line of a road as in OpenDRIVE: position, heading and slope over the distance s along the line. It
/// consists of straight lines, arcs and clothoids, so that its curvature is continuous. Equal arguments give equal
/// lines; const calls are safe from several threads.
class ReferenceLine {
 public:
  struct Point {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< on the road's surface, x right, y down, z forward, m
    double heading = 0.0;                                ///< rad, 0 along +z, positive to the right (+x)
    double pitch = 0.0;                                  ///< rad, slope of the road, positive uphill
    double curvature = 0.0;                              ///< of the heading, 1/m, positive to the right
  };
  /// Starts at the origin, level and along +z. `shape` is one of
  ///   "straight",
  ///   "curved": bends of 60 m to 300 m radius,
  ///   "turns": up to four right-angle turns of 8 m radius, about 80 m apart, the first after about 40 m, as many as
  ///            `length_m` holds.
  /// `slope` (rise over run) is the largest slope of the hills, which are sums of sines. The line never comes near an
  /// earlier part of itself. Error (kConfiguration) for an unknown shape or a number out of range.
  ReferenceLine(const std::string& shape, double length_m, double slope, std::uint64_t seed);

  double length() const { return length_; }
  /// The line is straight before 0. After length() it completes the bend that it is in, then it is straight.
  Point PointAt(double distance_m) const;
  /// Unit tangent.
  static Eigen::Vector3d Tangent(const Point& point);
  /// Distances of the junctions' centres, increasing, within [0, length()]: the middles of the turns on "turns", places
  /// on straight segments on the other shapes.
  const std::vector<double>& junctions() const { return junctions_; }

 private:
  /// A part of the line whose curvature is linear in the distance.
  struct Segment {
    double start = 0.0;
    double length = 0.0;
    double curvature_start = 0.0;
    double curvature_end = 0.0;
    double heading_start = 0.0;
  };
  struct Wave {
    double wavenumber = 0.0;  ///< rad/m
    double phase = 0.0;       ///< rad
    double slope = 0.0;       ///< amplitude
  };
  struct Node {
    Eigen::Vector3d position;
    Eigen::Vector3d tangent;
  };

  void Append(double length, double curvature_start, double curvature_end);
  /// A bend by `angle` (rad, positive to the right): clothoid, arc, clothoid.
  void AppendBend(double angle, double radius, double clothoid);
  void AddCurves(Random* random);
  void AddTurns(Random* random);
  void AddJunctions(Random* random);
  void AddHills(double slope, Random* random);
  void IntegratePosition();
  /// Heading, pitch and curvature, without the position.
  Point DirectionAt(double distance) const;
  double end() const { return segments_.back().start + segments_.back().length; }

  double length_ = 0.0;
  std::vector<double> junctions_;
  std::vector<Segment> segments_;
  std::vector<Wave> hills_;
  std::vector<Node> nodes_;
  double node_spacing_ = 0.0;
};

}  // namespace evo::simulation
