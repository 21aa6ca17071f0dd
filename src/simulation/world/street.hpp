#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "evo/core/random.hpp"
#include "evo/simulation/world.hpp"
#include "simulation/world/scene_builder.hpp"
#include "simulation/world/textures.hpp"

namespace evo::simulation {

/// Where the parts of a street lie. Places are given by the distance along the road, the lateral offset from the line
/// that the camera drives on (the middle of the right lane; positive to the right) and the height above the road, m.
class StreetPlan {
 public:
  /// A stretch without kerbs and houses where another road meets.
  struct Crossing {
    double from = 0.0;
    double to = 0.0;
    Eigen::Vector3d centre;             ///< where the middles of the roads meet
    Eigen::Vector3d forward;            ///< in the crossing's plane, unit length
    Eigen::Vector3d right;              ///< level, unit length
    std::vector<Eigen::Vector3d> arms;  ///< directions of the roads that ours does not take, unit length
  };

  StreetPlan(const RoadLine& road, const StreetOptions& options, double camera_height_m);

  Eigen::Vector3d At(double distance, double lateral, double up) const;
  /// Level unit vector to the right.
  Eigen::Vector3d Right(double distance) const;
  Eigen::Vector3d Forward(double distance) const;
  double Heading(double distance) const { return road_.At(distance).heading; }
  double Curvature(double distance) const { return road_.At(distance).curvature; }
  double Pitch(double distance) const { return road_.At(distance).pitch; }

  /// The street goes on before the start and past the end of the drive.
  double begin() const { return -kBehind; }
  double end() const { return road_.length() + kAhead; }
  double length() const { return road_.length(); }
  /// Of the carriageway, parking strips included.
  const CarriagewayLayout& layout() const { return layout_; }
  double middle() const { return -0.25 * layout_.lanes_m; }  ///< lateral offset of the road's middle
  double kerb(int side) const { return middle() + 0.5 * side * layout_.width(); }  ///< -1: left, 1: right
  double house_line(int side) const { return kerb(side) + side * pavement_; }
  double pavement() const { return pavement_; }
  const std::vector<Crossing>& crossings() const { return crossings_; }
  /// Whether [from, to] is farther than `margin` from all crossings.
  bool IsClearOfCrossings(double from, double to, double margin) const;
  /// Whether none of the points lies on any road or its pavements, seen from above.
  bool IsFree(const std::vector<Eigen::Vector3d>& points) const;

 private:
  struct Circle {
    double x = 0.0;
    double z = 0.0;
    double radius = 0.0;
  };
  static constexpr double kBehind = 30.0;
  static constexpr double kAhead = 120.0;

  void AddCrossing(double distance);
  void MarkRoads();

  RoadLine road_;
  CarriagewayLayout layout_;
  double pavement_;
  double camera_height_;
  std::vector<Crossing> crossings_;
  std::vector<Circle> taken_;
};

/// How long the roads are that leave at a crossing.
inline constexpr double kArmLength = 48.0;
inline constexpr double kKerbHeight = 0.12;

// The parts of a street. Each draws from a random stream of its own.
struct StreetTask {
  std::shared_ptr<const StreetPlan> shared_plan;  ///< moving bodies keep it
  const StreetOptions& options;
  SceneBuilder& builder;
  std::uint64_t seed = 0;
  bool night = false;
  const StreetPlan& plan = *shared_plan;
};
void AddRoadSurface(const StreetTask& task);
void AddCrossings(const StreetTask& task);
void AddFacades(const StreetTask& task);
void AddTrees(const StreetTask& task);
void AddPoles(const StreetTask& task);
void AddParkedCars(const StreetTask& task);
void AddOncomingCars(const StreetTask& task);
void AddCarsAhead(const StreetTask& task, const std::function<double(TimeNs)>& camera_distance_m);

/// Textures of houses, shared by those along the road and along its side roads.
class HouseFactory {
 public:
  HouseFactory(SceneBuilder* builder, bool night, Random* random);
  /// Width of a front of so many window axes.
  static constexpr double kAxisWidth = 3.1;
  struct Place {
    Eigen::Vector3d corner;   ///< one end of the front's foot
    Eigen::Vector3d along;    ///< to its other end, m
    Eigen::Vector3d inwards;  ///< unit vector away from the road
    double depth = 8.0;
    int axes = 3;
  };
  void Build(Place place, Random* random);

 private:
  void AddFront(const Place& place, int upper, int ground, int floors, double tone, Random* random);
  void AddEaves(const Place& place, double height, double tone, Random* random);
  void AddLitWindows(const Place& place, int floors, Random* random);
  void AddSigns(const Place& place, Random* random);

  SceneBuilder& builder_;
  bool night_;
  std::vector<int> uppers_, grounds_, walls_, signs_;
  int roof_ = 0;
  int gable_ = 0;
  int lit_window_ = 0;
  int plain_ = 0;
};

}  // namespace evo::simulation
