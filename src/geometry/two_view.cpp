#include "evo/geometry/two_view.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "evo/geometry/triangulation.hpp"

namespace evo::geometry {

namespace {

constexpr std::size_t kSampleSize = 8;    // of the eight-point algorithm
constexpr int kRefineIterations = 10;     // of Gauss-Newton, which converges in a handful
constexpr int kMaxPolishRounds = 5;       // of refinement and new inliers, which settle in two or three
constexpr double kPolishCostRatio = 1.5;  // over the best cost so far; a sample that costs more is not refined
constexpr int kMinSamples = 40;           // even if the first one is good, since there may be a second optimum

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Hartley's similarity: moves the centroid to the origin and scales the mean distance from it to sqrt(2).
std::optional<Matrix3d> Normalizer(std::span<const Correspondence> pairs, Vector2d Correspondence::*side) {
  Vector2d mean = Vector2d::Zero();
  for (const auto& pair : pairs) mean += pair.*side;
  mean /= static_cast<double>(pairs.size());
  double distance = 0.0;
  for (const auto& pair : pairs) distance += (pair.*side - mean).norm();
  distance /= static_cast<double>(pairs.size());
  if (!(distance > 1e-12)) return std::nullopt;
  const double scale = M_SQRT2 / distance;
  Matrix3d normalizer;
  normalizer << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
  return normalizer;
}

bool InFrontOfBoth(const Correspondence& pair, const SE3& T_2_1) {
  const auto depths = TriangulatePair(pair.x1, pair.x2, T_2_1);
  return depths && depths->z1 > 0.0 && depths->z2 > 0.0;
}

/// The motion, of the four, with the most points in front of both cameras.
SE3 ChooseByCheirality(const Matrix3d& essential, std::span<const Correspondence> pairs) {
  SE3 T_2_1_best;
  std::ptrdiff_t max_count = -1;
  for (const SE3& T_2_1 : DecomposeEssential(essential)) {
    const auto count = std::ranges::count_if(pairs, [&](const auto& pair) { return InFrontOfBoth(pair, T_2_1); });
    if (count > max_count) {
      max_count = count;
      T_2_1_best = T_2_1;
    }
  }
  return T_2_1_best;
}

/// The derivatives of E by the five parameters: left rotations about x, y, z and translations along two tangents.
std::array<Matrix3d, 5> EssentialDerivatives(const SE3& T_2_1, const Vector3d& tangent1, const Vector3d& tangent2) {
  const Matrix3d rotation = T_2_1.RotationMatrix();
  const Matrix3d hat = so3::Hat(T_2_1.translation());
  return {hat * so3::Hat(Vector3d::UnitX()) * rotation, hat * so3::Hat(Vector3d::UnitY()) * rotation,
          hat * so3::Hat(Vector3d::UnitZ()) * rotation, so3::Hat(tangent1) * rotation, so3::Hat(tangent2) * rotation};
}

double SampsonWithJacobian(const Matrix3d& essential, const std::array<Matrix3d, 5>& derivatives,
                           const Correspondence& pair, Eigen::Matrix<double, 5, 1>* jacobian) {
  const Vector3d x1 = pair.x1.homogeneous();
  const Vector3d x2 = pair.x2.homogeneous();
  const Vector3d line2 = essential * x1;
  const Vector3d line1 = essential.transpose() * x2;
  const double length = std::sqrt(std::max(line1.head<2>().squaredNorm() + line2.head<2>().squaredNorm(), 1e-24));
  const double error = x2.dot(line2) / length;
  for (int k = 0; k < 5; ++k) {
    const Vector3d change2 = derivatives[k] * x1;
    const Vector3d change1 = derivatives[k].transpose() * x2;
    const double change_of_length =
        (line1.head<2>().dot(change1.head<2>()) + line2.head<2>().dot(change2.head<2>())) / length;
    (*jacobian)[k] = (x2.dot(change2) - error * change_of_length) / length;
  }
  return error;
}

/// The direction of the translation that explains two pairs without a rotation. In nearly affine views (narrow lens,
/// sideways motion) a rotation with reversed translation and depths explains all pairs almost as well, and all
/// eight-point samples may end in that second optimum; this start leads to the first.
std::optional<Vector3d> PureTranslation(const Correspondence& a, const Correspondence& b) {
  const Vector3d normal_a = a.x1.homogeneous().cross(a.x2.homogeneous());
  const Vector3d normal_b = b.x1.homogeneous().cross(b.x2.homogeneous());
  const Vector3d t = normal_a.cross(normal_b);
  if (!(t.norm() > 1e-3 * normal_a.norm() * normal_b.norm())) return std::nullopt;
  return t.normalized();
}

/// A motion with its inliers; `cost` is the sum of the truncated squared errors (MSAC; P. H. S. Torr, A. Zisserman,
/// 2000).
struct Candidate {
  RelativePose pose;
  double cost = 0.0;
};

Candidate ScoreMotion(std::span<const Correspondence> pairs, const SE3& T_2_1, double max_error) {
  const Matrix3d essential = EssentialMatrix(T_2_1);
  Candidate result{{T_2_1, std::vector<bool>(pairs.size()), 0}, 0.0};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double error = std::abs(SampsonError(essential, pairs[i]));
    const bool inlier = error < max_error && InFrontOfBoth(pairs[i], T_2_1);
    result.pose.inliers[i] = inlier;
    result.pose.inlier_count += inlier ? 1 : 0;
    result.cost += inlier ? error * error : max_error * max_error;
  }
  return result;
}

std::vector<Correspondence> Select(std::span<const Correspondence> pairs, const std::vector<bool>& chosen) {
  std::vector<Correspondence> selected;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (chosen[i]) selected.push_back(pairs[i]);
  }
  return selected;
}

/// Refines a motion on its inliers as long as its cost falls.
Candidate Polish(std::span<const Correspondence> pairs, Candidate best, double max_error) {
  for (int round = 0; round < kMaxPolishRounds && best.pose.inlier_count >= static_cast<int>(kSampleSize); ++round) {
    const SE3 T_2_1_refined = RefineRelativePose(Select(pairs, best.pose.inliers), best.pose.T_2_1);
    Candidate candidate = ScoreMotion(pairs, T_2_1_refined, max_error);
    if (!(candidate.cost < best.cost)) break;
    best = std::move(candidate);
  }
  return best;
}

/// RANSAC's number of samples for that inlier ratio (Multiple View Geometry, 4.18).
int SamplesNeeded(int inliers, std::size_t total, const RelativePoseOptions& options) {
  const double all_inliers = std::pow(static_cast<double>(inliers) / static_cast<double>(total), kSampleSize);
  if (all_inliers > 1.0 - 1e-9) return 0;
  const double needed = std::log1p(-options.confidence) / std::log1p(-all_inliers);
  return needed < options.max_samples ? static_cast<int>(needed) + 1 : options.max_samples;
}

}  // namespace

std::optional<Matrix3d> EightPoint(std::span<const Correspondence> pairs) {
  if (pairs.size() < kSampleSize) return std::nullopt;
  const auto normalizer1 = Normalizer(pairs, &Correspondence::x1);
  const auto normalizer2 = Normalizer(pairs, &Correspondence::x2);
  if (!normalizer1 || !normalizer2) return std::nullopt;
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (const auto& pair : pairs) {
    const Vector3d a = *normalizer1 * pair.x1.homogeneous();
    const Vector3d b = *normalizer2 * pair.x2.homogeneous();
    Eigen::Matrix<double, 9, 1> row;  // equation 12; e by the rows of E as in (11) and (13)
    row << b.x() * a, b.y() * a, a;
    normal += row * row.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(normal);
  const Eigen::Matrix<double, 9, 1> e = solver.eigenvectors().col(0);
  Matrix3d raw;
  raw << e.segment<3>(0).transpose(), e.segment<3>(3).transpose(), e.segment<3>(6).transpose();
  raw = normalizer2->transpose() * raw * *normalizer1;
  const Eigen::JacobiSVD<Matrix3d> svd(raw, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * Vector3d(1, 1, 0).asDiagonal() * svd.matrixV().transpose();
}

std::array<SE3, 4> DecomposeEssential(const Matrix3d& essential) {
  const Eigen::JacobiSVD<Matrix3d> svd(essential, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d u = svd.matrixU();
  Matrix3d v = svd.matrixV();
  if (u.determinant() < 0) u.col(2) *= -1.0;
  if (v.determinant() < 0) v.col(2) *= -1.0;
  Matrix3d W;  // rotation by 90 degrees about z
  W << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Eigen::Quaterniond first(Matrix3d(u * W * v.transpose()));
  const Eigen::Quaterniond second(Matrix3d(u * W.transpose() * v.transpose()));
  const Vector3d t = u.col(2);
  return {SE3(first, t), SE3(first, -t), SE3(second, t), SE3(second, -t)};
}

Matrix3d EssentialMatrix(const SE3& T_2_1) { return so3::Hat(T_2_1.translation()) * T_2_1.RotationMatrix(); }

double SampsonError(const Matrix3d& essential, const Correspondence& pair) {
  const Vector3d line2 = essential * pair.x1.homogeneous();
  const Vector3d line1 = essential.transpose() * pair.x2.homogeneous();
  const double gradient2 = line1.head<2>().squaredNorm() + line2.head<2>().squaredNorm();
  return pair.x2.homogeneous().dot(line2) / std::sqrt(std::max(gradient2, 1e-24));
}

SE3 RefineRelativePose(std::span<const Correspondence> pairs, const SE3& T_2_1_initial) {
  SE3 T_2_1(T_2_1_initial.rotation(), T_2_1_initial.translation().normalized());
  for (int i = 0; i < kRefineIterations; ++i) {
    const Vector3d t = T_2_1.translation();
    const Vector3d tangent1 = t.unitOrthogonal();
    const Vector3d tangent2 = t.cross(tangent1);
    const Matrix3d essential = EssentialMatrix(T_2_1);
    const auto derivatives = EssentialDerivatives(T_2_1, tangent1, tangent2);
    Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
    Eigen::Matrix<double, 5, 1> gradient = Eigen::Matrix<double, 5, 1>::Zero();
    for (const auto& pair : pairs) {
      Eigen::Matrix<double, 5, 1> jacobian;
      const double error = SampsonWithJacobian(essential, derivatives, pair, &jacobian);
      normal += jacobian * jacobian.transpose();
      gradient += jacobian * error;
    }
    normal.diagonal().array() += 1e-9 * normal.diagonal().maxCoeff();
    const Eigen::Matrix<double, 5, 1> step = -normal.ldlt().solve(gradient);
    if (!step.allFinite()) break;
    T_2_1 =
        SE3(so3::Exp(step.head<3>()) * T_2_1.rotation(), (t + step[3] * tangent1 + step[4] * tangent2).normalized());
    if (step.norm() < 1e-10) break;
  }
  return T_2_1;
}

std::optional<RelativePose> EstimateRelativePose(std::span<const Correspondence> pairs,
                                                 const RelativePoseOptions& options) {
  if (pairs.size() < kSampleSize) return std::nullopt;
  // std::mt19937 is specified bit by bit, and core's generator would draw other samples: other maps.
  std::mt19937 random(options.seed);
  std::vector<std::size_t> order(pairs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<Correspondence> sample(kSampleSize);
  Candidate best;
  best.cost = std::numeric_limits<double>::infinity();
  const auto consider = [&](const SE3& T_2_1) {
    const Candidate candidate = ScoreMotion(pairs, T_2_1, options.max_sampson_error);
    // A sample's motion is far from the best for its inliers, so costs are compared after the refinement.
    if (!(candidate.cost < kPolishCostRatio * best.cost)) return;
    Candidate polished = Polish(pairs, candidate, options.max_sampson_error);
    if (polished.cost < best.cost) best = std::move(polished);
  };
  int needed = options.max_samples;
  for (int i = 0; i < std::max(needed, kMinSamples); ++i) {
    for (std::size_t k = 0; k < kSampleSize; ++k) {  // a partial Fisher-Yates shuffle; the modulo's bias is below 1e-6
      std::swap(order[k], order[k + random() % (order.size() - k)]);
      sample[k] = pairs[order[k]];
    }
    if (const auto essential = EightPoint(sample)) consider(ChooseByCheirality(*essential, sample));
    if (const auto translation = PureTranslation(sample[0], sample[1])) {
      consider(SE3(Eigen::Quaterniond::Identity(), *translation));
      consider(SE3(Eigen::Quaterniond::Identity(), -*translation));
    }
    needed = std::min(options.max_samples, SamplesNeeded(best.pose.inlier_count, pairs.size(), options));
  }
  if (best.pose.inlier_count < static_cast<int>(kSampleSize)) return std::nullopt;
  return best.pose;
}

}  // namespace evo::geometry
