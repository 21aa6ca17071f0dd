#include "evo/evaluation/alignment.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "evo/core/error.hpp"

namespace evo::evaluation {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

Error Degenerate(const std::string& alignment, const std::string& what, const std::string& remedy) {
  return {ErrorKind::kDegenerateAlignment, "alignment '" + alignment + "': " + what + "; " + remedy};
}

geometry::SE3 AlignFirstPose(const PosePair& first) {
  return first.T_world_cam_truth * first.T_world_cam_estimate.Inverse();
}

Similarity AlignOriginAndScale(std::span<const PosePair> pairs, const std::string& name) {
  const geometry::SE3& first_truth = pairs.front().T_world_cam_truth;
  const geometry::SE3 T_truth_estimate = AlignFirstPose(pairs.front());
  double cross = 0.0;
  double square = 0.0;
  for (const auto& pair : pairs) {
    const Eigen::Vector3d moved =
        T_truth_estimate * pair.T_world_cam_estimate.translation() - first_truth.translation();
    cross += moved.dot(pair.T_world_cam_truth.translation() - first_truth.translation());
    square += moved.squaredNorm();
  }
  if (square / static_cast<double>(pairs.size()) <= kEpsilon || cross <= 0.0) {
    throw Degenerate(
        name, "no positive scale fits the positions after the first pose (" + std::to_string(pairs.size()) + " poses)",
        "choose --align none or origin, or a longer interval with motion");
  }
  const double scale = cross / square;
  // Scaling about the first true position, written as a similarity about the world's origin.
  const Eigen::Vector3d origin = first_truth.translation();
  return {scale,
          geometry::SE3(T_truth_estimate.rotation(), scale * (T_truth_estimate.translation() - origin) + origin)};
}

/// S. Umeyama, Least-squares estimation of transformation parameters between two point patterns, PAMI 1991, equations
/// 38-43, with evo's check that the positions span a plane.
Similarity AlignLeastSquares(std::span<const PosePair> pairs, bool with_scale, const std::string& name) {
  const auto n = static_cast<double>(pairs.size());
  Eigen::Vector3d mean_estimate = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_truth = Eigen::Vector3d::Zero();
  for (const auto& pair : pairs) {
    mean_estimate += pair.T_world_cam_estimate.translation() / n;
    mean_truth += pair.T_world_cam_truth.translation() / n;
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double variance_estimate = 0.0;
  for (const auto& pair : pairs) {
    const Eigen::Vector3d estimate = pair.T_world_cam_estimate.translation() - mean_estimate;
    const Eigen::Vector3d truth = pair.T_world_cam_truth.translation() - mean_truth;
    covariance += truth * estimate.transpose() / n;
    variance_estimate += estimate.squaredNorm() / n;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& singular = svd.singularValues();
  if (singular[1] <= kEpsilon * std::max(1.0, singular[0])) {
    throw Degenerate(name, "the " + std::to_string(pairs.size()) + " matched positions lie on a line or a point",
                     "choose --align origin or origin-scale, or a longer interval");
  }
  Eigen::Vector3d sign(1, 1, svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1);
  const Eigen::Matrix3d rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  const double scale = with_scale ? singular.dot(sign) / variance_estimate : 1.0;
  return {scale, geometry::SE3(Eigen::Quaterniond(rotation), mean_truth - scale * (rotation * mean_estimate))};
}

/// The angle of the rotation about `up` that makes the sum of (R b - a)^2 over the columns of `a` and `b` least: with
/// R b = cos b + sin (up x b) + (1 - cos) (up . b) up, the sum of a . R b is largest.
double BestYaw(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b, const Eigen::Vector3d& up,
               const std::string& name) {
  double sine = 0.0;
  double cosine = 0.0;
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    sine += up.dot(b.col(i).cross(a.col(i)));
    cosine += a.col(i).dot(b.col(i)) - up.dot(a.col(i)) * up.dot(b.col(i));
  }
  if (std::hypot(sine, cosine) <= kEpsilon * static_cast<double>(a.cols())) {
    throw Degenerate(name, "the " + std::to_string(a.cols()) + " matched positions do not leave the vertical",
                     "choose --align origin or posyaw:1, or a longer interval");
  }
  return std::atan2(sine, cosine);
}

Similarity AlignPositionAndYaw(std::span<const PosePair> pairs, const Eigen::Vector3d& up, const std::string& name) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::Matrix3Xd truth(3, n);
  Eigen::Matrix3Xd estimate(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    truth.col(i) = pairs[static_cast<std::size_t>(i)].T_world_cam_truth.translation();
    estimate.col(i) = pairs[static_cast<std::size_t>(i)].T_world_cam_estimate.translation();
  }
  const Eigen::Vector3d mean_truth = truth.rowwise().mean();
  const Eigen::Vector3d mean_estimate = estimate.rowwise().mean();
  const double yaw = n == 1 ? BestYaw(pairs.front().T_world_cam_truth.RotationMatrix(),
                                      pairs.front().T_world_cam_estimate.RotationMatrix(), up, name)
                            : BestYaw(truth.colwise() - mean_truth, estimate.colwise() - mean_estimate, up, name);
  const Eigen::Quaterniond rotation = geometry::so3::Exp(yaw * up);
  return {1.0, geometry::SE3(rotation, mean_truth - rotation * mean_estimate)};
}

/// Those that `alignment` is determined from; never none.
std::span<const PosePair> Spanned(std::span<const PosePair> pairs, const Alignment& alignment) {
  if (alignment.first_poses) return pairs.first(std::min(*alignment.first_poses, pairs.size()));
  if (!alignment.first_seconds) return pairs;
  const TimeNs end = pairs.front().t_truth + FromSeconds(*alignment.first_seconds);
  const auto last = std::ranges::upper_bound(pairs, end, {}, &PosePair::t_truth);
  return pairs.first(static_cast<std::size_t>(last - pairs.begin()));
}

constexpr double kLongestSpan = 1e6;  // s

/// ":100" or ":5s" into the fields of `alignment`; false if `text` is neither.
bool ParseSpan(const std::string& text, Alignment* alignment) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [last, failure] = std::from_chars(text.data() + 1, end, value);
  if (failure != std::errc() || !(value > 0.0 && value < kLongestSpan)) return false;
  if (last == end && value == std::floor(value)) alignment->first_poses = static_cast<std::size_t>(value);
  if (std::string(last, end) == "s") alignment->first_seconds = value;
  return alignment->first_poses || alignment->first_seconds;
}

}  // namespace

Eigen::Vector3d Similarity::operator*(const Eigen::Vector3d& point) const {
  return T_truth_estimate.rotation() * (scale * point) + T_truth_estimate.translation();
}

geometry::SE3 Similarity::operator*(const geometry::SE3& T_world_cam) const {
  return {T_truth_estimate.rotation() * T_world_cam.rotation(), *this * T_world_cam.translation()};
}

Alignment ParseAlignment(const std::string& text) {
  using Method = Alignment::Method;
  static const std::map<std::string, Method> kMethods{
      {"none", Method::kNone},   {"origin", Method::kOrigin}, {"origin-scale", Method::kOriginScale},
      {"scale", Method::kScale}, {"posyaw", Method::kPosYaw}, {"se3", Method::kSe3},
      {"sim3", Method::kSim3}};
  const std::string prefix = "first:";
  const std::string meant = text.starts_with(prefix) ? "sim3:" + text.substr(prefix.size()) + "s" : text;
  const auto colon = std::min(meant.find(':'), meant.size());
  const auto method = kMethods.find(meant.substr(0, colon));
  if (method != kMethods.end()) {
    Alignment alignment{method->second, std::nullopt, std::nullopt, text};
    const bool may_span = method->second != Method::kNone && method->second != Method::kOrigin;
    if (colon == meant.size() || (may_span && ParseSpan(meant.substr(colon), &alignment))) return alignment;
  }
  throw Error(ErrorKind::kUsage, "alignment '" + text +
                                     "' is unknown; choose among none, origin, origin-scale, scale, posyaw, se3 and "
                                     "sim3, the last five also over a beginning such as sim3:100 (poses) or sim3:5s");
}

std::vector<Alignment> ParseAlignments(const std::string& text) {
  std::vector<Alignment> alignments;
  std::istringstream list(text);
  for (std::string name; std::getline(list, name, ',');) {
    const Alignment alignment = ParseAlignment(name);
    if (std::ranges::find(alignments, name, &Alignment::name) == alignments.end()) alignments.push_back(alignment);
  }
  if (alignments.empty()) throw Error(ErrorKind::kUsage, "no alignment given; for example origin-scale,sim3");
  return alignments;
}

Similarity Align(std::span<const PosePair> pairs, const Alignment& alignment, const Eigen::Vector3d& up) {
  using Method = Alignment::Method;
  const std::string& name = alignment.name;
  if (alignment.method == Method::kNone) return {};
  if (pairs.empty()) throw Degenerate(name, "no matched poses", "check that the stamps overlap");
  const auto spanned = Spanned(pairs, alignment);
  switch (alignment.method) {
    case Method::kOrigin:
      return {1.0, AlignFirstPose(pairs.front())};
    case Method::kOriginScale:
      return AlignOriginAndScale(spanned, name);
    case Method::kScale:
      return {AlignLeastSquares(spanned, true, name).scale, geometry::SE3()};
    case Method::kPosYaw:
      return AlignPositionAndYaw(spanned, up, name);
    default:
      return AlignLeastSquares(spanned, alignment.method == Method::kSim3, name);
  }
}

}  // namespace evo::evaluation
