#pragma once

#include <vector>

#include "evo/simulation/motion.hpp"

namespace evo::simulation {

/// How far a car has come and how fast it is over time: acceleration within its limit, changes of acceleration smooth.
class SpeedProfile {
 public:
  SpeedProfile(const RoadLine& road, const VehicleOptions& options);

  /// Before the start and after the end the car keeps its speed.
  double Distance(double t_s) const;
  double Speed(double t_s) const;

 private:
  /// Speeds at multiples of the step from the first to the last instant that smoothing needs.
  static std::vector<double> Drive(const RoadLine& road, const VehicleOptions& options, int samples);

  std::vector<double> speeds_;
  std::vector<double> distances_;
};

}  // namespace evo::simulation
