#include "evo/odometry/motion_prior.hpp"

#include <cmath>
#include <utility>

#include "odometry/median.hpp"

namespace evo {

namespace {

constexpr double kMedianToSigma = 0.6501;  // the norm of a 3-d unit Gaussian has the median 1.5382

Vector6d Change(const SE3& to_here, const SE3& to_after, double before_s, double after_s) {
  return (to_after.Log() / after_s - to_here.Log() / before_s) / std::sqrt(0.5 * (before_s + after_s));
}

/// The commutator with a twist: Exp(a) Exp(b) ~ Exp(a + b + ad(a) b / 2).
Eigen::Matrix<double, 6, 6> Commutator(const Vector6d& twist) {
  Eigen::Matrix<double, 6, 6> ad = Eigen::Matrix<double, 6, 6>::Zero();
  ad.topLeftCorner<3, 3>() = ad.bottomRightCorner<3, 3>() = so3::Hat(twist.tail<3>());
  ad.topRightCorner<3, 3>() = so3::Hat(twist.head<3>());
  return ad;
}

}  // namespace

Vector6d MeasureVelocityChange(const SE3& before, const SE3& here, const SE3& after, double before_s, double after_s) {
  return Change(here * before.Inverse(), after * here.Inverse(), before_s, after_s);
}

VelocityChange LinearizeVelocityChange(const SE3& before, const SE3& here, const SE3& after, double before_s,
                                       double after_s) {
  const SE3 to_here = here * before.Inverse();
  const SE3 to_after = after * here.Inverse();
  const double root = std::sqrt(0.5 * (before_s + after_s));
  // Log(Exp(d) M) ~ Log(M) + (1 - ad / 2 + ad^2 / 12) d, and Log(M Exp(-d)) ~ Log(M) - (1 + ad / 2 + ad^2 / 12) d.
  const auto by_end = [](const Eigen::Matrix<double, 6, 6>& ad, double sign) {
    return Eigen::Matrix<double, 6, 6>(Eigen::Matrix<double, 6, 6>::Identity() - 0.5 * sign * ad + ad * ad / 12.0);
  };
  const auto first = Commutator(to_here.Log());
  const auto second = Commutator(to_after.Log());
  VelocityChange change;
  change.value = Change(to_here, to_after, before_s, after_s);
  change.by_before = by_end(first, -1.0) / (before_s * root);
  change.by_here = -by_end(second, -1.0) / (after_s * root) - by_end(first, 1.0) / (before_s * root);
  change.by_after = by_end(second, 1.0) / (after_s * root);
  return change;
}

MotionPrior MeasureMotion(const std::vector<SE3>& poses, std::vector<double> t, double times, double sigma_px) {
  std::vector<double> translations, rotations;
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const Vector6d change =
        MeasureVelocityChange(poses[i - 1], poses[i], poses[i + 1], t[i] - t[i - 1], t[i + 1] - t[i]);
    translations.push_back(change.head<3>().norm());
    rotations.push_back(change.tail<3>().norm());
  }
  const double translation = times * kMedianToSigma * Median(std::move(translations));
  const double rotation = times * kMedianToSigma * Median(std::move(rotations));
  if (!(translation > 0.0 && rotation > 0.0)) return {};
  return {std::move(t), sigma_px / translation, sigma_px / rotation};
}

}  // namespace evo
