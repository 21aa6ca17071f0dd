#include "evo/odometry/pose_uncertainty.hpp"

#include <algorithm>
#include <random>

#include "odometry/bundle_equations.hpp"
#include "odometry/median.hpp"

namespace evo {

namespace {

constexpr Eigen::Index kSamples = 100;
constexpr std::size_t kReach = 25;      // poses between which a turn is compared with the usual
constexpr double kUncertain = 3.0;      // times the usual standard deviation
constexpr std::size_t kMostShare = 10;  // of the run: one in so many may be left out at either end

/// Ad(T) in twists (translation, rotation): T Exp(d) = Exp(Ad(T) d) T.
Matrix6d Adjoint(const SE3& T) {
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = T.RotationMatrix();
  adjoint.topRightCorner<3, 3>() = so3::Hat(T.translation()) * T.RotationMatrix();
  return adjoint;
}

}  // namespace

PoseUncertainty::PoseUncertainty(const BundleOptions& options, const BundleProblem& problem, ThreadPool* pool)
    : poses_(problem.T_cam_world),
      samples_(Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(problem.T_cam_world.size()), kSamples)) {
  const auto begin = FirstObservations(problem);
  const ErrorModel model{InnovationSteps(problem, options.drift), options.loss_px};
  BundleEquations equations(problem, model, begin, pool);
  equations.Linearize();
  if (!equations.Factorize()) return;
  std::mt19937 random(1);  // its numbers, unlike those of distributions, are the same everywhere
  std::vector<std::vector<double>> signs(kSamples, std::vector<double>(problem.points.size()));
  for (auto& of_sample : signs) {
    for (double& sign : of_sample) sign = random() % 2 == 0 ? 1.0 : -1.0;
  }
  ForEachIndex(pool, kSamples, 1, [&](std::size_t k) {
    const Eigen::VectorXd steps = equations.StepsIf(signs[k]);
    samples_.col(static_cast<Eigen::Index>(k)).tail(steps.size()) = steps;
  });
}

std::vector<Matrix6d> PoseUncertainty::Covariances(std::size_t origin) const {
  std::vector<Matrix6d> covariances;
  const auto of_origin = samples_.middleRows<6>(6 * static_cast<Eigen::Index>(origin));
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Eigen::Matrix<double, 6, Eigen::Dynamic> relative = samples_.middleRows<6>(6 * static_cast<Eigen::Index>(i)) -
                                                              Adjoint(poses_[i] * poses_[origin].Inverse()) * of_origin;
    covariances.emplace_back(relative * relative.transpose() / static_cast<double>(kSamples));
  }
  return covariances;
}

double PoseUncertainty::Turn(std::size_t from, std::size_t to) const {
  const auto rotation = [&](std::size_t pose) {
    return samples_.middleRows<3>(6 * static_cast<Eigen::Index>(pose) + 3);
  };
  const Eigen::Matrix3d turn = (poses_[to] * poses_[from].Inverse()).RotationMatrix();
  return (rotation(to) - turn * rotation(from)).norm() / std::sqrt(static_cast<double>(kSamples));
}

std::pair<std::size_t, std::size_t> PoseUncertainty::CertainStretch() const {
  const std::size_t count = poses_.size();
  const std::size_t reach = std::min(kReach, count / 4);
  if (reach == 0) return {0, count};
  std::vector<double> turns;
  for (std::size_t i = 0; i + reach < count; ++i) turns.push_back(Turn(i, i + reach));
  const double limit = kUncertain * Median(turns);
  const auto certain = [&](double turn) { return turn <= limit; };
  const auto most = static_cast<std::ptrdiff_t>(count / kMostShare);
  const auto begin = std::find_if(turns.begin(), turns.begin() + most, certain) - turns.begin();
  const auto after = std::find_if(turns.rbegin(), turns.rbegin() + most, certain) - turns.rbegin();
  return {static_cast<std::size_t>(begin), count - static_cast<std::size_t>(after)};
}

}  // namespace evo
