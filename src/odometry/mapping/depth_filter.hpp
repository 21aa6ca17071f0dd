#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "evo/odometry/odometry_options.hpp"
#include "odometry/frontend/frame.hpp"

namespace evo::odometry {

/// The depth estimate of one feature, as in rpg_svo: a Gaussian of the inverse distance along the feature's ray times a
/// Beta distribution of the inlier probability rho. It approximates the posterior of the measurement model
/// rho N(x; d, tau^2) + (1 - rho) U(x) (D. Zhu, equation 8) after G. Vogiatzis, C. Hernandez: Video-based, Real-Time
/// Multi-View Stereo, Image and Vision Computing 2011.
struct Seed {
  std::int64_t track = 0;                          ///< the feature's
  int key_frame = 0;                               ///< the reference camera, by any number that the caller understands
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();  ///< unit vector in the reference camera
  Eigen::Vector2d x = Eigen::Vector2d::Zero();     ///< the same on the reference's normalized plane z = 1
  double a = 10.0;                                 ///< of the Beta distribution; grows with each inlier measurement
  double b = 10.0;                                 ///< of the Beta distribution; grows with each outlier measurement
  double mu = 0.0;                                 ///< mean of the Gaussian, 1 / unit of length
  double z_range = 0.0;  ///< width of the uniform distribution of outliers, 1 / unit of length
  double sigma2 = 0.0;   ///< variance of the Gaussian, 1 / unit of length squared

  /// The expected inlier probability.
  double inlier_ratio() const { return a / (a + b); }
};

/// Updates a seed with a measured inverse distance `x` of standard deviation `tau`, by matching the first two moments
/// of the exact posterior (Vogiatzis and Hernandez, supplementary material).
void UpdateSeed(double x, double tau, Seed* seed);

/// Standard deviation of a triangulated distance `z` along the unit vector `ray`, whose observation in the second view
/// has an error of `angle` rad, by the law of sines. `t` is the second camera's centre in the reference camera.
double DepthUncertainty(const Eigen::Vector3d& ray, const Eigen::Vector3d& t, double z, double angle);

/// The seeds that have not converged. A converged seed is handed over and leaves.
class DepthFilter {
 public:
  using OnConverged = std::function<void(const Seed&)>;

  /// `pixel_angle` is the angle of one pixel, 2 atan(1 / 2f) rad.
  DepthFilter(const DepthFilterOptions& options, double pixel_angle, OnConverged on_converged);

  /// Adds a seed with mean inverse distance 1 / `mean_depth` and range 1 / `min_depth`, unless its track has one.
  void AddSeed(const Feature& feature, int key_frame, double mean_depth, double min_depth);

  /// Updates every seed whose track the frame observes. `T_cam_key(key_frame)` is the frame's pose relative to a seed's
  /// reference.
  void Update(const Frame& frame, const std::function<geometry::SE3(int)>& T_cam_key);

  /// Drops seeds whose reference is more than max_age key frames older than `key_frame`.
  void DropOld(int key_frame);
  void Clear() { seeds_.clear(); }

  bool Has(std::int64_t track) const;
  /// In order of tracks.
  const std::vector<Seed>& seeds() const { return seeds_; }

 private:
  enum class SeedState { kActive, kConverged, kRejected };
  SeedState Measure(const Feature& feature, const geometry::SE3& T_cam_key, Seed* seed) const;

  DepthFilterOptions options_;
  double pixel_angle_;
  OnConverged on_converged_;
  std::vector<Seed> seeds_;
};

}  // namespace evo::odometry
