#include "odometry/bundle/motion_prior.hpp"

#include <cmath>
#include <utility>

#include "evo/core/median.hpp"

namespace evo::odometry {

namespace {

constexpr double kMedianToSigma = 0.6501;  // the norm of a 3-d unit Gaussian has the median 1.5382

/// The motions to and from a pose and the times that they take.
struct Motions {
  Motions(const std::vector<geometry::SE3>& poses, const std::vector<double>& t, std::size_t i)
      : before_s(t[i] - t[i - 1]),
        after_s(t[i + 1] - t[i]),
        root(std::sqrt(0.5 * (before_s + after_s))),
        before((poses[i] * poses[i - 1].Inverse()).Log()),
        after((poses[i + 1] * poses[i].Inverse()).Log()) {}

  geometry::Vector6d Change() const { return (after / after_s - before / before_s) / root; }

  double before_s, after_s;
  double root;
  geometry::Vector6d before, after;
};

/// The commutator with a twist: Exp(a) Exp(b) ~ Exp(a + b + ad(a) b / 2).
geometry::Matrix6d Commutator(const geometry::Vector6d& twist) {
  geometry::Matrix6d ad = geometry::Matrix6d::Zero();
  ad.topLeftCorner<3, 3>() = ad.bottomRightCorner<3, 3>() = geometry::so3::Hat(twist.tail<3>());
  ad.topRightCorner<3, 3>() = geometry::so3::Hat(twist.head<3>());
  return ad;
}

}  // namespace

geometry::Vector6d MeasureVelocityChange(const std::vector<geometry::SE3>& poses, const std::vector<double>& t,
                                         std::size_t i) {
  return Motions(poses, t, i).Change();
}

VelocityChange LinearizeVelocityChange(const std::vector<geometry::SE3>& poses, const std::vector<double>& t,
                                       std::size_t i) {
  const Motions motions(poses, t, i);
  // Log(Exp(d) M) ~ Log(M) + (1 - ad / 2 + ad^2 / 12) d, and Log(M Exp(-d)) ~ Log(M) - (1 + ad / 2 + ad^2 / 12) d.
  const auto by_end = [](const geometry::Matrix6d& ad, double sign) {
    return geometry::Matrix6d(geometry::Matrix6d::Identity() - 0.5 * sign * ad + ad * ad / 12.0);
  };
  const geometry::Matrix6d first = Commutator(motions.before);
  const geometry::Matrix6d second = Commutator(motions.after);
  const double first_s = motions.before_s * motions.root;
  const double second_s = motions.after_s * motions.root;
  VelocityChange change;
  change.value = motions.Change();
  change.by_before = by_end(first, -1.0) / first_s;
  change.by_here = -by_end(second, -1.0) / second_s - by_end(first, 1.0) / first_s;
  change.by_after = by_end(second, 1.0) / second_s;
  return change;
}

MotionPrior MeasureMotion(const std::vector<geometry::SE3>& poses, std::vector<double> t, double times,
                          double sigma_px) {
  std::vector<double> translations, rotations;
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const geometry::Vector6d change = MeasureVelocityChange(poses, t, i);
    translations.push_back(change.head<3>().norm());
    rotations.push_back(change.tail<3>().norm());
  }
  const double translation = times * kMedianToSigma * Median(std::move(translations));
  const double rotation = times * kMedianToSigma * Median(std::move(rotations));
  if (!(translation > 0.0 && rotation > 0.0)) return {};
  return {std::move(t), sigma_px / translation, sigma_px / rotation};
}

}  // namespace evo::odometry
