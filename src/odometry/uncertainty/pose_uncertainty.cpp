#include "odometry/uncertainty/pose_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "evo/core/median.hpp"
#include "odometry/bundle/bundle_equations.hpp"

namespace evo::odometry {

namespace {

constexpr Eigen::Index kSamples = 100;
constexpr std::size_t kReach = 25;       // poses between which a turn is compared with the usual
constexpr double kUncertainStart = 2.0;  // times the usual standard deviation: the first pose turns the whole path
constexpr double kUncertainEnd = 3.0;
constexpr std::size_t kMostShare = 10;  // of the run: one in so many may be left out at either end

Eigen::Index Row(std::size_t pose) { return 6 * static_cast<Eigen::Index>(pose); }

/// +1 or -1, the same on every machine, unlike the numbers of distributions.
class Signs {
 public:
  explicit Signs(unsigned seed) : random_(seed) {}

  double Next() { return random_() % 2 == 0 ? 1.0 : -1.0; }

 private:
  std::mt19937 random_;
};

/// Ad(T) in twists (translation, rotation): T Exp(d) = Exp(Ad(T) d) T.
geometry::Matrix6d Adjoint(const geometry::SE3& T) {
  geometry::Matrix6d adjoint = geometry::Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = T.RotationMatrix();
  adjoint.topRightCorner<3, 3>() = geometry::so3::Hat(T.translation()) * T.RotationMatrix();
  return adjoint;
}

/// Of every frame the median angle by which the tracks have moved since the frame before.
std::vector<double> ImageMotion(const BundleProblem& problem) {
  std::vector<std::vector<double>> angles(problem.T_cam_world.size());
  for (std::size_t i = 1; i < problem.observations.size(); ++i) {
    const BundleObservation& before = problem.observations[i - 1];
    const BundleObservation& here = problem.observations[i];
    if (here.point != before.point || here.frame != before.frame + 1) continue;
    const Eigen::Vector3d ray = here.x.homogeneous();
    const Eigen::Vector3d old_ray = before.x.homogeneous();
    angles[here.frame].push_back(std::atan2(ray.cross(old_ray).norm(), ray.dot(old_ray)));
  }
  std::vector<double> motion;
  for (auto& of_frame : angles) motion.push_back(of_frame.empty() ? 0.0 : Median(std::move(of_frame)));
  return motion;
}

/// Positions of the cameras.
std::vector<Eigen::Vector3d> Centres(const std::vector<geometry::SE3>& T_cam_world) {
  std::vector<Eigen::Vector3d> centres;
  for (const geometry::SE3& pose : T_cam_world) centres.push_back(pose.Inverse().translation());
  return centres;
}

}  // namespace

PoseUncertainty::PoseUncertainty(const CovarianceOptions& common, const BundleOptions& options,
                                 const BundleProblem& problem, ThreadPool* pool)
    : certain_(0, problem.T_cam_world.size()),
      poses_(problem.T_cam_world),
      samples_(Eigen::MatrixXd::Zero(Row(problem.T_cam_world.size()), kSamples)) {
  const auto begin = FirstObservations(problem);
  const ErrorModel model{InnovationSteps(problem, options.drift), options.loss_px, true};
  BundleEquations equations(problem, model, begin, pool);
  equations.Linearize();
  known_ = equations.Factorize();
  if (!known_) return;
  Signs random(1);
  std::vector<std::vector<double>> signs(kSamples, std::vector<double>(problem.points.size()));
  for (auto& of_sample : signs) {
    for (double& sign : of_sample) sign = random.Next();
  }
  ForEachIndex(pool, kSamples, 1, [&](std::size_t k) {
    const Eigen::VectorXd steps = std::sqrt(common.variance_inflation) * equations.StepsIf(signs[k]);
    samples_.col(static_cast<Eigen::Index>(k)).tail(steps.size()) = steps;
  });
  certain_ = FindCertainStretch();

  // A turn of the whole image is taken for one of the camera, the whole path behind it turns along.
  Eigen::Matrix<double, 3, Eigen::Dynamic> axes(3, kSamples);
  for (double& axis : axes.reshaped()) axis = common.rotation_bias_ratio * random.Next();
  const std::vector<double> motion = ImageMotion(problem);
  Rows turned = Rows::Zero(6, kSamples);
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    turned = (Adjoint(poses_[i] * poses_[i - 1].Inverse()) * turned).eval();
    turned.bottomRows<3>() += motion[i] * axes;
    samples_.middleRows<6>(Row(i)) += turned;
  }
}

void PoseUncertainty::Cut(std::size_t begin, std::size_t end) {
  samples_ = samples_.middleRows(Row(begin), Row(end - begin)).eval();
  poses_ = {poses_.begin() + static_cast<std::ptrdiff_t>(begin), poses_.begin() + static_cast<std::ptrdiff_t>(end)};
}

void PoseUncertainty::HoldScale(const std::vector<geometry::SE3>& T_cam_world, double error, double reach) {
  const auto old_centres = Centres(poses_);
  const auto centres = Centres(T_cam_world);
  const std::size_t count = poses_.size();
  std::vector<double> way(count), old_length(count), length(count);  // of the steps that lead to each pose
  for (std::size_t i = 1; i < count; ++i) {
    old_length[i] = (old_centres[i] - old_centres[i - 1]).norm();
    length[i] = (centres[i] - centres[i - 1]).norm();
    way[i] = way[i - 1] + length[i];
  }
  Signs random(2);
  std::vector<double> too_long(count);  // of the way to each pose
  for (Eigen::Index k = 0; k < samples_.cols(); ++k) {
    const auto moved = [&](std::size_t i) -> Eigen::Vector3d {
      return -(poses_[i].RotationMatrix().transpose() * samples_.block<3, 1>(Row(i), k));
    };
    // What the tracks say about the scale, as far as it is the same over a way of `reach`, is replaced.
    std::vector<Eigen::Vector3d> steps(count, Eigen::Vector3d::Zero());
    for (std::size_t i = 1; i < count; ++i) {
      const double scale = old_length[i] > 0.0 ? length[i] / old_length[i] : 1.0;
      steps[i] = scale * (moved(i) - moved(i - 1));
      const Eigen::Vector3d step = centres[i] - centres[i - 1];
      too_long[i] = too_long[i - 1] + (length[i] > 0.0 ? steps[i].dot(step) / length[i] : 0.0);
    }
    double known = error * random.Next();  // how much too large the scale is thought to be
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::size_t from = 0, to = 0;
    for (std::size_t i = 0; i < count; ++i) {
      while (way[i] - way[from] > 0.5 * reach) ++from;
      while (to + 1 < count && way[to] - way[i] < 0.5 * reach) ++to;
      const double span = way[to] - way[from];
      const double told = span > 0.0 ? (too_long[to] - too_long[from]) / span : 0.0;
      const double kept = reach > 0.0 ? std::exp(-length[i] / reach) : 0.0;
      known = kept * known + std::sqrt(1.0 - kept * kept) * error * random.Next();
      if (i > 0) position += steps[i] + (known - told) * (centres[i] - centres[i - 1]);
      samples_.block<3, 1>(Row(i), k) = -(T_cam_world[i].RotationMatrix() * position);
    }
  }
  poses_ = T_cam_world;
}

PoseUncertainty::Rows PoseUncertainty::Relative(std::size_t pose, std::size_t origin) const {
  return samples_.middleRows<6>(Row(pose)) -
         Adjoint(poses_[pose] * poses_[origin].Inverse()) * samples_.middleRows<6>(Row(origin));
}

std::vector<geometry::Matrix6d> PoseUncertainty::Covariances(std::size_t origin, bool scale_is_free) const {
  const auto centres = Centres(poses_);
  const auto away = [&](std::size_t i) -> Eigen::Vector3d { return centres[i] - centres[origin]; };
  Eigen::RowVectorXd too_large = Eigen::RowVectorXd::Zero(samples_.cols());  // the scale
  if (scale_is_free) {
    double squares = 0.0;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      too_large -= (poses_[i].RotationMatrix() * away(i)).transpose() * Relative(i, origin).topRows<3>();
      squares += away(i).squaredNorm();
    }
    too_large /= squares > 0.0 ? squares : 1.0;
  }
  std::vector<geometry::Matrix6d> covariances;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    Rows relative = Relative(i, origin);
    if (scale_is_free) relative.topRows<3>() += poses_[i].RotationMatrix() * away(i) * too_large;
    covariances.emplace_back(relative * relative.transpose() / static_cast<double>(samples_.cols()));
  }
  return covariances;
}

double PoseUncertainty::Turn(std::size_t from, std::size_t to) const {
  return Relative(to, from).bottomRows<3>().norm() / std::sqrt(static_cast<double>(samples_.cols()));
}

std::pair<std::size_t, std::size_t> PoseUncertainty::FindCertainStretch() const {
  const std::size_t count = poses_.size();
  const std::size_t reach = std::min(kReach, count / 4);
  if (reach == 0) return {0, count};
  std::vector<double> turns;
  for (std::size_t i = 0; i + reach < count; ++i) turns.push_back(Turn(i, i + reach));
  const double usual = Median(turns);
  const auto within = [&](double limit) { return [usual, limit](double turn) { return turn <= limit * usual; }; };
  const auto most = static_cast<std::ptrdiff_t>(count / kMostShare);
  const auto begin = std::find_if(turns.begin(), turns.begin() + most, within(kUncertainStart)) - turns.begin();
  const auto after = std::find_if(turns.rbegin(), turns.rbegin() + most, within(kUncertainEnd)) - turns.rbegin();
  return {static_cast<std::size_t>(begin), count - static_cast<std::size_t>(after)};
}

}  // namespace evo::odometry
