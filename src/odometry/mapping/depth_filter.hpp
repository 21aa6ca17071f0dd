#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "evo/geometry/se3.hpp"
#include "evo/odometry/odometry_options.hpp"
#include "odometry/frontend/frame.hpp"

namespace evo::odometry {

/// What is believed about the inverse distance of one feature along its unit ray from the key frame that first saw it:
/// a Gaussian times a Beta distribution of the share of good measurements (equation 8; Vogiatzis and Hernandez, 2011).
struct Seed {
  std::int64_t track = 0;
  int key_frame = 0;                               ///< the reference; any id that the caller understands
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();  ///< unit, in the reference camera
  Eigen::Vector2d x = Eigen::Vector2d::Zero();     ///< the same on the reference's plane z = 1
  double a = 10.0;                                 ///< Beta: good measurements
  double b = 10.0;                                 ///< Beta: bad measurements
  double mu = 0.0;                                 ///< mean inverse distance, 1/m
  double z_range = 0.0;                            ///< width of the uniform part, 1/m
  double sigma2 = 0.0;                             ///< variance of the inverse distance, 1/m^2

  double inlier_ratio() const { return a / (a + b); }
};

/// Fuses one measurement of the inverse distance `x` with standard deviation `tau` by moment matching.
void UpdateSeed(double x, double tau, Seed* seed);

/// Standard deviation of a triangulated distance `z` along `ray` for an angle of `angle` rad in the second view, by the
/// law of sines. `t` is the second camera's centre in the reference camera.
double DepthUncertainty(const Eigen::Vector3d& ray, const Eigen::Vector3d& t, double z, double angle);

/// The seeds that have not converged yet. Knows nothing of the map: converged seeds go to the callback and leave.
class DepthFilter {
 public:
  using OnConverged = std::function<void(const Seed&)>;

  /// `px_angle` is the angle of one pixel, 2 atan(1 / 2f) rad.
  DepthFilter(const DepthFilterOptions& options, double px_angle, OnConverged on_converged);

  /// A seed with mean inverse depth 1 / `mean_depth` and range 1 / `min_depth`, unless the track has one.
  void AddSeed(const Feature& feature, int key_frame, double mean_depth, double min_depth);

  /// Measures every seed whose track the frame sees. `T_cam_key(key_frame)` gives the frame's camera relative to a
  /// seed's reference.
  void Update(const Frame& frame, const std::function<geometry::SE3(int)>& T_cam_key);

  /// Forgets seeds whose reference is older than max_age key frames before `key_frame`.
  void DropOld(int key_frame);
  void Drop(std::int64_t track);
  void Clear() { seeds_.clear(); }

  bool Has(std::int64_t track) const;
  /// In order of tracks.
  const std::vector<Seed>& seeds() const { return seeds_; }

 private:
  enum class Verdict { kKeep, kConverged, kDrop };
  Verdict Measure(const Feature& feature, const geometry::SE3& T_cam_key, Seed* seed) const;

  DepthFilterOptions options_;
  double px_angle_;
  OnConverged on_converged_;
  std::vector<Seed> seeds_;
};

}  // namespace evo::odometry
