#pragma once

#include <Eigen/Core>
#include <vector>

#include "evo/core/random.hpp"
#include "simulation/world/scene_builder.hpp"

namespace evo::simulation {

/// Builds houses that share a set of textures.
class HouseFactory {
 public:
  /// Lit windows at `night`, with mirror images in a `wet` road.
  HouseFactory(SceneBuilder* builder, bool night, bool wet, Random* random);
  static constexpr double kAxisWidth = 3.1;  // m: width of the facade per window axis
  /// The ground plan of a house.
  struct Site {
    Eigen::Vector3d corner;   ///< one end of the facade's foot
    Eigen::Vector3d along;    ///< from there to its other end, m
    Eigen::Vector3d inwards;  ///< unit vector away from the road
    double depth = 8.0;
    int axes = 3;  ///< window axes
  };
  void Build(Site site, Random* random);

 private:
  void AddFacade(const Site& site, int upper, int ground, int floors, double tone, Random* random);
  void AddEaves(const Site& site, double height, double tone, Random* random);
  void AddLitWindows(const Site& site, int floors, Random* random);
  void AddSigns(const Site& site, Random* random);

  SceneBuilder& builder_;
  bool night_;
  bool wet_;
  std::vector<int> uppers_, grounds_, walls_, signs_;
  int roof_ = 0;
  int gable_ = 0;
  int lit_window_ = 0;
  int plain_ = 0;
};

}  // namespace evo::simulation
