#include "evo/evaluation/alignment.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "evo/core/error.hpp"

namespace evo {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

Error Degenerate(const std::string& alignment, const std::string& what, const std::string& remedy) {
  return {ErrorKind::kDegenerateAlignment, "alignment '" + alignment + "': " + what + "; " + remedy};
}

SE3 AlignFirstPose(const PosePair& first) { return first.T_world_cam_truth * first.T_world_cam_estimate.Inverse(); }

Similarity AlignOriginAndScale(std::span<const PosePair> pairs, const std::string& name) {
  const SE3& first_truth = pairs.front().T_world_cam_truth;
  const SE3 T_truth_estimate = AlignFirstPose(pairs.front());
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
  return {scale, SE3(T_truth_estimate.rotation(), scale * (T_truth_estimate.translation() - origin) + origin)};
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
  return {scale, SE3(Eigen::Quaterniond(rotation), mean_truth - scale * (rotation * mean_estimate))};
}

std::span<const PosePair> FirstSeconds(std::span<const PosePair> pairs, double seconds) {
  const TimeNs end = pairs.front().t_truth + FromSeconds(seconds);
  const auto last = std::ranges::upper_bound(pairs, end, {}, &PosePair::t_truth);
  return pairs.first(static_cast<std::size_t>(last - pairs.begin()));
}

}  // namespace

Eigen::Vector3d Similarity::operator*(const Eigen::Vector3d& point) const {
  return T_truth_estimate.rotation() * (scale * point) + T_truth_estimate.translation();
}

SE3 Similarity::operator*(const SE3& T_world_cam) const {
  return {T_truth_estimate.rotation() * T_world_cam.rotation(), *this * T_world_cam.translation()};
}

Alignment ParseAlignment(const std::string& text) {
  using Kind = Alignment::Kind;
  if (text == "none") return {Kind::kNone, 0.0, text};
  if (text == "origin") return {Kind::kOrigin, 0.0, text};
  if (text == "origin-scale") return {Kind::kOriginScale, 0.0, text};
  if (text == "se3") return {Kind::kSe3, 0.0, text};
  if (text == "sim3") return {Kind::kSim3, 0.0, text};
  const std::string prefix = "first:";
  if (text.starts_with(prefix)) {
    double seconds = 0.0;
    const char* const end = text.data() + text.size();
    const auto [last, failure] = std::from_chars(text.data() + prefix.size(), end, seconds);
    if (failure == std::errc() && last == end && seconds > 0.0 && seconds < 1e6) return {Kind::kFirst, seconds, text};
  }
  throw Error(ErrorKind::kUsage, "alignment '" + text +
                                     "' is unknown; choose among none, origin, origin-scale, se3, sim3 and "
                                     "first:SECONDS");
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

Similarity Align(std::span<const PosePair> pairs, const Alignment& alignment) {
  if (alignment.kind == Alignment::Kind::kNone) return {};
  if (pairs.empty()) throw Degenerate(alignment.name, "no matched poses", "check that the stamps overlap");
  switch (alignment.kind) {
    case Alignment::Kind::kOrigin:
      return {1.0, AlignFirstPose(pairs.front())};
    case Alignment::Kind::kOriginScale:
      return AlignOriginAndScale(pairs, alignment.name);
    case Alignment::Kind::kSe3:
      return AlignLeastSquares(pairs, false, alignment.name);
    case Alignment::Kind::kSim3:
      return AlignLeastSquares(pairs, true, alignment.name);
    default:
      return AlignLeastSquares(FirstSeconds(pairs, alignment.seconds), true, alignment.name);
  }
}

}  // namespace evo
