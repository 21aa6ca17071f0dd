#include "evaluation/trajectory/matched_trajectory.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include "evo/core/error.hpp"

namespace evo::evaluation {

double MatchedTrajectory::TranslationError(std::size_t first, std::size_t last) const {
  const Eigen::Vector3d true_motion = truth[last] - truth[first];
  return (estimate[last] - estimate[first] - rotation_error[first] * true_motion).norm();
}

Eigen::Quaterniond MatchedTrajectory::RotationError(std::size_t first, std::size_t last) const {
  return rotation_error[last] * rotation_error[first].conjugate();
}

MatchedTrajectory BuildMatchedTrajectory(std::span<const PosePair> pairs, const Similarity& similarity) {
  MatchedTrajectory trajectory;
  double distance = 0.0;
  for (const auto& pair : pairs) {
    const geometry::SE3 aligned = similarity * pair.T_world_cam_estimate;
    const geometry::SE3& truth = pair.T_world_cam_truth;
    if (!trajectory.truth.empty()) distance += (truth.translation() - trajectory.truth.back()).norm();
    trajectory.t.push_back(pair.t_truth);
    trajectory.distance.push_back(distance);
    trajectory.truth.push_back(truth.translation());
    trajectory.estimate.push_back(aligned.translation());
    trajectory.rotation_error.push_back((aligned.rotation() * truth.rotation().conjugate()).normalized());
  }
  return trajectory;
}

double RotationAngle(const Eigen::Quaterniond& rotation) {
  return 2.0 * std::atan2(rotation.vec().norm(), std::abs(rotation.w()));
}

std::vector<double> ParseLengths(const std::string& text, double path_m) {
  std::vector<double> lengths;
  std::istringstream list(text);
  for (std::string item; std::getline(list, item, ',');) {
    const char* const end = item.data() + item.size();
    double length = 0.0;
    const auto [last, failure] = std::from_chars(item.data(), end, length);
    const std::string_view unit(last, end);
    if (failure != std::errc() || !std::isfinite(length) || length <= 0.0 ||
        (!unit.empty() && unit != "m" && unit != "%")) {
      throw Error(
          ErrorKind::kConfiguration,
          "'" + item + "' is not a length; give positive metres or percent of the path, for example 100,50m,10%");
    }
    if (unit == "%") length *= path_m / 100.0;
    if (length > 0.0 && std::ranges::find(lengths, length) == lengths.end()) lengths.push_back(length);
  }
  if (text.empty())
    throw Error(ErrorKind::kConfiguration, "the list of lengths is empty; give for example 100,50m,10%");
  return lengths;
}

}  // namespace evo::evaluation
