#pragma once

#include <vector>

#include "evo/simulation/scene_options.hpp"
#include "simulation/world/reference_line.hpp"

namespace evo::simulation {

/// Distance (m) and speed (m/s) of a car over time. The acceleration stays within its limit and is continuous.
class SpeedProfile {
 public:
  SpeedProfile(const ReferenceLine& road, const VehicleOptions& options);

  /// The car keeps its speed before the start and after the end.
  double DistanceAt(double t_s) const;
  double SpeedAt(double t_s) const;

 private:
  /// Speeds before smoothing, one a step, from the first to the last instant that the smoothing needs.
  static std::vector<double> IntegrateSpeeds(const ReferenceLine& road, const VehicleOptions& options, int samples);

  std::vector<double> speeds_;
  std::vector<double> distances_;
};

}  // namespace evo::simulation
