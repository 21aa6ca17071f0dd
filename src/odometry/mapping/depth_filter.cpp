#include "odometry/mapping/depth_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "evo/geometry/triangulation.hpp"

namespace evo::odometry {

namespace {

constexpr double kPriorCount = 10.0;    // a = b of a new seed, as in rpg_svo: an open mind about the track
constexpr double kRangeSigmas = 6.0;    // standard deviations of a new seed in its range, as in rpg_svo
constexpr double kMinDistance = 1e-7;   // keeps the inverse distance finite, as in rpg_svo
constexpr double kMinLineNorm = 1e-12;  // unit of length; at the epipole every direction fits

double NormalDensity(double x, double mean, double variance) {
  const double d = x - mean;
  return std::exp(-0.5 * d * d / variance) / std::sqrt(2.0 * std::numbers::pi * variance);
}

/// Distance of the feature from its epipolar line, px.
double EpipolarDistancePx(const Seed& seed, const Feature& feature, const geometry::SE3& T_cam_key) {
  const Eigen::Vector3d line = T_cam_key.translation().cross(T_cam_key.rotation() * seed.ray);
  const double length = line.head<2>().norm();
  if (!(length > kMinLineNorm)) return 0.0;
  const Eigen::Vector2d across = line.head<2>() / length;
  const double distance = feature.x.homogeneous().dot(line) / length;
  return (feature.J_pixel_normalized * (distance * across)).norm();
}

}  // namespace

void UpdateSeed(double x, double tau, Seed* seed) {
  const double tau2 = tau * tau;
  const double spread2 = seed->sigma2 + tau2;
  const double s2 = 1.0 / (1.0 / seed->sigma2 + 1.0 / tau2);
  const double m = s2 * (seed->mu / seed->sigma2 + x / tau2);
  const double a = seed->a;
  const double b = seed->b;
  double c1 = a / (a + b) * NormalDensity(x, seed->mu, spread2);
  double c2 = b / (a + b) / seed->z_range;
  const double sum = c1 + c2;
  if (!(sum > 0.0) || !std::isfinite(sum) || !std::isfinite(m)) return;
  c1 /= sum;
  c2 /= sum;
  // First (f) and second (e) moment of the exact posterior by the inlier probability, then by the inverse distance.
  const double f = c1 * (a + 1.0) / (a + b + 1.0) + c2 * a / (a + b + 1.0);
  const double e = c1 * (a + 1.0) * (a + 2.0) / ((a + b + 1.0) * (a + b + 2.0)) +
                   c2 * a * (a + 1.0) / ((a + b + 1.0) * (a + b + 2.0));
  const double mu = c1 * m + c2 * seed->mu;
  const double sigma2 = c1 * (s2 + m * m) + c2 * (seed->sigma2 + seed->mu * seed->mu) - mu * mu;
  const double new_a = (e - f) / (f - e / f);
  const double new_b = new_a * (1.0 - f) / f;
  if (!std::isfinite(new_a) || !std::isfinite(new_b) || !(sigma2 > 0.0)) return;
  seed->mu = mu;
  seed->sigma2 = sigma2;
  seed->a = new_a;
  seed->b = new_b;
}

double DepthUncertainty(const Eigen::Vector3d& ray, const Eigen::Vector3d& t, double z, double angle) {
  const Eigen::Vector3d second_ray = z * ray - t;
  const double baseline = t.norm();
  const double alpha = std::atan2(ray.cross(t).norm(), ray.dot(t));
  const double beta = std::atan2(second_ray.cross(-t).norm(), second_ray.dot(-t));
  const double gamma = std::numbers::pi - alpha - (beta + angle);  // at the point, with the error
  if (!(std::sin(gamma) > 0.0 && gamma > 0.0)) return std::numeric_limits<double>::infinity();
  return std::abs(baseline * std::sin(beta + angle) / std::sin(gamma) - z);
}

DepthFilter::DepthFilter(const DepthFilterOptions& options, double pixel_angle, OnConverged on_converged)
    : options_(options), pixel_angle_(pixel_angle), on_converged_(std::move(on_converged)) {}

void DepthFilter::AddSeed(const Feature& feature, int key_frame, double mean_depth, double min_depth) {
  const auto place = std::ranges::lower_bound(seeds_, feature.track, {}, &Seed::track);
  if (place != seeds_.end() && place->track == feature.track) return;
  Seed seed;
  seed.track = feature.track;
  seed.key_frame = key_frame;
  seed.ray = feature.x.homogeneous().normalized();
  seed.x = feature.x;
  seed.a = seed.b = kPriorCount;
  seed.mu = 1.0 / mean_depth;
  seed.z_range = 1.0 / min_depth;
  seed.sigma2 = seed.z_range * seed.z_range / (kRangeSigmas * kRangeSigmas);
  seeds_.insert(place, seed);
}

void DepthFilter::Update(const Frame& frame, const std::function<geometry::SE3(int)>& T_cam_key) {
  auto kept = seeds_.begin();
  for (auto& seed : seeds_) {
    const Feature* const feature = frame.Find(seed.track);
    const SeedState state = feature ? Measure(*feature, T_cam_key(seed.key_frame), &seed) : SeedState::kActive;
    if (state == SeedState::kConverged) on_converged_(seed);
    if (state == SeedState::kActive) *kept++ = seed;
  }
  seeds_.erase(kept, seeds_.end());
}

DepthFilter::SeedState DepthFilter::Measure(const Feature& feature, const geometry::SE3& T_cam_key, Seed* seed) const {
  const auto depths = geometry::TriangulatePair(seed->x, feature.x, T_cam_key);  // equations 6-7
  if (EpipolarDistancePx(*seed, feature, T_cam_key) > options_.epipolar_px) {
    seed->b += 1.0;                                              // an outlier
  } else if (depths && depths->z1 > 0.0 && depths->z2 > 0.0) {   // else the baseline is too short for the point
    const double z = depths->z1 * seed->x.homogeneous().norm();  // along the ray
    const double tau =
        DepthUncertainty(seed->ray, T_cam_key.Inverse().translation(), z, options_.pixel_noise * pixel_angle_);
    const double tau_inverse = 0.5 * (1.0 / std::max(kMinDistance, z - tau) - 1.0 / (z + tau));
    if (std::isfinite(tau)) UpdateSeed(1.0 / z, tau_inverse, seed);  // equation 8
  }
  if (seed->inlier_ratio() < options_.min_inlier_ratio) return SeedState::kRejected;
  const bool converged = std::sqrt(seed->sigma2) < seed->z_range / options_.convergence && seed->mu > 0.0;
  return converged ? SeedState::kConverged : SeedState::kActive;
}

void DepthFilter::DropOld(int key_frame) {
  std::erase_if(seeds_, [&](const Seed& seed) { return key_frame - seed.key_frame > options_.max_age; });
}

bool DepthFilter::Has(std::int64_t track) const { return std::ranges::binary_search(seeds_, track, {}, &Seed::track); }

}  // namespace evo::odometry
