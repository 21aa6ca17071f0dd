#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "evo/core/random.hpp"
#include "evo/simulation/scene_options.hpp"
#include "simulation/world/reference_line.hpp"
#include "simulation/world/scene_builder.hpp"
#include "simulation/world/textures.hpp"

namespace evo::simulation {

/// The layout of a street in its Frenet frame: distance along the road's reference line, which is the camera's path,
/// lateral offset from it (positive to the right) and height above the road, m.
class StreetPlan {
 public:
  /// A part of the road without kerbs and houses, where another road meets it.
  struct Junction {
    double from = 0.0;  ///< distance, m
    double to = 0.0;
    Eigen::Vector3d centre;             ///< intersection of the roads' centre lines
    Eigen::Vector3d forward;            ///< in the junction's plane, unit length
    Eigen::Vector3d right;              ///< level, unit length
    std::vector<Eigen::Vector3d> arms;  ///< directions of the side roads, unit length
  };

  StreetPlan(const ReferenceLine& road, const StreetOptions& options, double camera_height_m);

  /// Position in the world.
  Eigen::Vector3d PointAt(double distance, double lateral, double up) const;
  /// Level unit vector to the right.
  Eigen::Vector3d Right(double distance) const;
  /// Unit tangent of the road.
  Eigen::Vector3d Forward(double distance) const;
  double Heading(double distance) const { return road_.PointAt(distance).heading; }
  double Curvature(double distance) const { return road_.PointAt(distance).curvature; }

  /// The street begins before the start of the drive and ends past its end.
  double begin() const { return -kBehind; }
  double end() const { return road_.length() + kAhead; }
  /// Of the carriageway with its parking strips.
  const CarriagewayLayout& layout() const { return layout_; }
  int own_side() const { return own_side_; }  ///< of the centre line that the camera drives on
  // Lateral offsets; side -1: left, 1: right.
  double centre_line() const { return own_lane() - 0.25 * own_side_ * layout_.lanes_m; }
  double own_lane() const { return own_lane_; }  ///< its centre
  double other_lane() const { return own_lane() - 0.5 * own_side_ * layout_.lanes_m; }
  double kerb(int side) const { return centre_line() + 0.5 * side * layout_.width(); }
  double house_line(int side) const { return kerb(side) + side * pavement_; }
  double pavement() const { return pavement_; }  ///< width, m
  const std::vector<Junction>& junctions() const { return junctions_; }
  /// True if [from, to] is farther than `margin` from all junctions.
  bool IsClearOfJunctions(double from, double to, double margin) const;
  /// True if, seen from above, none of the points lies on a road or its pavements.
  bool IsFree(const std::vector<Eigen::Vector3d>& points) const;

 private:
  struct Circle {
    double x = 0.0;
    double z = 0.0;
    double radius = 0.0;
  };
  static constexpr double kBehind = 30.0;  // m before the start
  static constexpr double kAhead = 120.0;  // m past the end: the street fills the view to the last instant

  void AddJunction(double distance);
  void MarkRoads();

  ReferenceLine road_;
  CarriagewayLayout layout_;
  double pavement_;
  double camera_height_;
  int own_side_;
  double own_lane_;
  std::vector<Junction> junctions_;
  std::vector<Circle> occupied_;  ///< by roads and pavements
};

inline constexpr double kArmLength = 48.0;   // m: side roads end in a house there
inline constexpr double kKerbHeight = 0.12;  // m

/// What the parts of a street are built from. Each part has a random stream of its own.
struct StreetContext {
  std::shared_ptr<const StreetPlan> shared_plan;  ///< moving bodies share it
  const StreetOptions& options;
  SceneBuilder& builder;
  std::uint64_t seed = 0;
  bool night = false;  ///< lamps are on
  const StreetPlan& plan = *shared_plan;
};
void AddRoadSurface(const StreetContext& context);
void AddJunctions(const StreetContext& context);
void AddFacades(const StreetContext& context);
void AddTrees(const StreetContext& context);
void AddPoles(const StreetContext& context);
void AddParkedCars(const StreetContext& context);
void AddOncomingCars(const StreetContext& context);
void AddCarsAhead(const StreetContext& context, const std::function<double(TimeNs)>& camera_distance_m);
void AddLorry(const StreetContext& context, const std::function<double(TimeNs)>& camera_distance_m);
void AddPedestrians(const StreetContext& context);
void AddCrossingPedestrians(const StreetContext& context, const std::function<double(TimeNs)>& camera_distance_m);

}  // namespace evo::simulation
