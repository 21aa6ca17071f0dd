#include "evo/evaluation/alignment.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include "evo/core/error.hpp"

namespace evo::evaluation {

namespace {

constexpr double kMaxSpan = 1e6;  // poses or s, keeps the conversion to nanoseconds in range

/// Parses ":100" or ":5s" into `alignment`; false for other texts.
bool ParseSpan(const std::string& text, Alignment* alignment) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [last, failure] = std::from_chars(text.data() + 1, end, value);
  if (failure != std::errc() || !(value > 0.0 && value < kMaxSpan)) return false;
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
  throw Error(ErrorKind::kUsage,
              "alignment '" + text +
                  "' is unknown; choose among none, origin, origin-scale, scale, posyaw, se3 and "
                  "sim3, the last five also with a span such as sim3:100 (first poses) or sim3:5s (first seconds)");
}

std::vector<Alignment> ParseAlignments(const std::string& text) {
  std::vector<Alignment> alignments;
  std::istringstream list(text);
  for (std::string name; std::getline(list, name, ',');) {
    const Alignment alignment = ParseAlignment(name);
    if (std::ranges::find(alignments, name, &Alignment::name) == alignments.end()) alignments.push_back(alignment);
  }
  if (alignments.empty())
    throw Error(ErrorKind::kUsage, "the list of alignments is empty; give for example origin-scale,sim3");
  return alignments;
}

}  // namespace evo::evaluation
