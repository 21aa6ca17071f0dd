#include "evo/evaluation/position_search.hpp"

#include <algorithm>
#include <utility>

namespace evo::evaluation {

namespace {

constexpr double kRounding = 1e-12;  // relative

}  // namespace

PositionSearch::PositionSearch(std::vector<Eigen::Vector3d> positions) : positions_(std::move(positions)) {
  levels_.emplace_back();
  for (const auto& position : positions_) levels_[0].push_back({Eigen::AlignedBox3d(position)});
  for (std::size_t length = 2; levels_.back().size() > 1; length *= 2) {
    const auto& below = levels_.back();
    std::vector<Run> level;
    for (std::size_t i = 0; i < below.size(); i += 2) {
      Run run = below[i];
      if (i + 1 < below.size()) run.box.extend(below[i + 1].box);
      const std::size_t first = level.size() * length;
      for (std::size_t k = first; k < std::min(first + length, positions_.size()); ++k) {
        run.radius = std::max(run.radius, (positions_[k] - run.box.center()).norm());
      }
      level.push_back(run);
    }
    levels_.push_back(std::move(level));
  }
}

bool PositionSearch::MayBeFar(std::size_t level, std::size_t node, const Eigen::Vector3d& center,
                              double distance) const {
  if (level == 0) return (positions_[node] - center).norm() >= distance;
  const auto& [box, radius] = levels_[level][node];
  if ((box.center() - center).norm() + radius < (1.0 - kRounding) * distance) return false;
  const Eigen::Vector3d to_corner = (box.min() - center).cwiseAbs().cwiseMax((box.max() - center).cwiseAbs());
  return to_corner.norm() >= distance;
}

std::optional<std::size_t> PositionSearch::FirstFar(std::size_t from, const Eigen::Vector3d& center,
                                                    double distance) const {
  std::size_t level = 0;
  std::size_t node = from;
  while (node < levels_[level].size()) {
    if (MayBeFar(level, node, center, distance)) {
      if (level == 0) return node;
      --level;
      node *= 2;
      continue;
    }
    ++node;
    for (; node % 2 == 0 && level + 1 < levels_.size(); ++level) node /= 2;
  }
  return std::nullopt;
}

std::optional<std::size_t> PositionSearch::LastFar(std::size_t from, const Eigen::Vector3d& center,
                                                   double distance) const {
  std::size_t level = 0;
  std::size_t end = from + 1;  // one past the node looked at
  while (end > 0) {
    if (MayBeFar(level, end - 1, center, distance)) {
      if (level == 0) return end - 1;
      --level;
      end = std::min(2 * end, levels_[level].size());
      continue;
    }
    --end;
    for (; end % 2 == 0 && end > 0 && level + 1 < levels_.size(); ++level) end /= 2;
  }
  return std::nullopt;
}

}  // namespace evo::evaluation
