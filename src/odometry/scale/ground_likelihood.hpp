#pragma once

#include <cstddef>
#include <vector>

namespace evo::odometry {

/// A track below the path, which may lie on the ground. It is described by its inverse depth below the path: noise
/// moves a track along its ray, and the error of its inverse depth is unbiased and independent of where the noise has
/// put it.
struct GroundObservation {
  double arc_length = 0.0;      ///< of the path's place above the track
  double inverse_height = 0.0;  ///< 1 / depth below the path
  double sigma = 0.0;           ///< standard deviation of the inverse height, up to a factor common to all
  double lateral_ratio = 0.0;   ///< offset to the right of the path over the depth below it
};

/// Of log(inverse height), up to which a track counts as below the ground. What a bonnet or a wet road mirrors seems to
/// lie deeper, down to what stands above the camera.
inline constexpr double kMaxBelowGround = 1.0;

/// How much more likely a track is if there is a ground than if there is none: a track lies on the ground or above it,
/// on a kerb, a wheel, a wall. Only gross errors and mirror images lie below it.
class GroundLikelihood {
 public:
  /// Learns where tracks are without regard to the ground.
  explicit GroundLikelihood(const std::vector<GroundObservation>& observations);

  /// Likelihood of an observation over that without a ground. `error` is log(inverse height) minus that of the ground
  /// there, `sigma` its standard deviation.
  double Ratio(std::size_t observation, double error, double sigma) const;
  /// Probability that the observation is on the ground.
  double GroundProbability(std::size_t observation, double error, double sigma) const;

 private:
  std::vector<double> background_;  // density of each observation's log(inverse height) without a ground
};

}  // namespace evo::odometry
