#include "odometry/bundle/motion_prior.hpp"

#include <cmath>
#include <utility>

#include "evo/core/median.hpp"

namespace evo::odometry {

namespace {

constexpr double kMedianNorm3ToSigma = 0.6501;  // the norm of a 3-d unit Gaussian has the median 1.5382

/// The motions to and from a pose and their durations.
struct AdjacentMotions {
  AdjacentMotions(const std::vector<geometry::SE3>& T_cam_world, const std::vector<double>& times_s, std::size_t i)
      : incoming_s(times_s[i] - times_s[i - 1]),
        outgoing_s(times_s[i + 1] - times_s[i]),
        root_s(std::sqrt(0.5 * (incoming_s + outgoing_s))),
        incoming((T_cam_world[i] * T_cam_world[i - 1].Inverse()).Log()),
        outgoing((T_cam_world[i + 1] * T_cam_world[i].Inverse()).Log()) {}

  geometry::Vector6d Change() const { return (outgoing / outgoing_s - incoming / incoming_s) / root_s; }

  double incoming_s, outgoing_s;
  double root_s;  // root of the time between the two velocities, s^0.5
  geometry::Vector6d incoming, outgoing;
};

/// ad(twist), the Lie bracket: Exp(a) Exp(b) ~ Exp(a + b + ad(a) b / 2) (Baker, Campbell, Hausdorff).
geometry::Matrix6d LieBracket(const geometry::Vector6d& twist) {
  geometry::Matrix6d ad = geometry::Matrix6d::Zero();
  ad.topLeftCorner<3, 3>() = ad.bottomRightCorner<3, 3>() = geometry::so3::Hat(twist.tail<3>());
  ad.topRightCorner<3, 3>() = geometry::so3::Hat(twist.head<3>());
  return ad;
}

}  // namespace

geometry::Vector6d ComputeVelocityChange(const std::vector<geometry::SE3>& T_cam_world,
                                         const std::vector<double>& times_s, std::size_t i) {
  return AdjacentMotions(T_cam_world, times_s, i).Change();
}

VelocityChange LinearizeVelocityChange(const std::vector<geometry::SE3>& T_cam_world,
                                       const std::vector<double>& times_s, std::size_t i) {
  const AdjacentMotions motions(T_cam_world, times_s, i);
  // Log(Exp(d) M) ~ Log(M) + (1 - ad / 2 + ad^2 / 12) d, and Log(M Exp(-d)) ~ Log(M) - (1 + ad / 2 + ad^2 / 12) d.
  const auto inverse_jacobian = [](const geometry::Matrix6d& ad, double sign) {
    return geometry::Matrix6d(geometry::Matrix6d::Identity() - 0.5 * sign * ad + ad * ad / 12.0);
  };
  const geometry::Matrix6d ad_incoming = LieBracket(motions.incoming);
  const geometry::Matrix6d ad_outgoing = LieBracket(motions.outgoing);
  const double incoming_s = motions.incoming_s * motions.root_s;
  const double outgoing_s = motions.outgoing_s * motions.root_s;
  VelocityChange change;
  change.value = motions.Change();
  change.J_previous = inverse_jacobian(ad_incoming, -1.0) / incoming_s;
  change.J_current =
      -inverse_jacobian(ad_outgoing, -1.0) / outgoing_s - inverse_jacobian(ad_incoming, 1.0) / incoming_s;
  change.J_next = inverse_jacobian(ad_outgoing, 1.0) / outgoing_s;
  return change;
}

MotionPrior EstimateMotionPrior(const std::vector<geometry::SE3>& T_cam_world, std::vector<double> times_s,
                                double velocity_change_scale, double sigma_px) {
  std::vector<double> translations, rotations;
  for (std::size_t i = 1; i + 1 < T_cam_world.size(); ++i) {
    const geometry::Vector6d change = ComputeVelocityChange(T_cam_world, times_s, i);
    translations.push_back(change.head<3>().norm());
    rotations.push_back(change.tail<3>().norm());
  }
  const double translation_sigma = velocity_change_scale * kMedianNorm3ToSigma * Median(std::move(translations));
  const double rotation_sigma = velocity_change_scale * kMedianNorm3ToSigma * Median(std::move(rotations));
  if (!(translation_sigma > 0.0 && rotation_sigma > 0.0)) return {};
  return {std::move(times_s), sigma_px / translation_sigma, sigma_px / rotation_sigma};
}

}  // namespace evo::odometry
