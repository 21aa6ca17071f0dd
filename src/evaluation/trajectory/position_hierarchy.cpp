#include "evaluation/trajectory/position_hierarchy.hpp"

#include <algorithm>
#include <utility>

namespace evo::evaluation {

namespace {

constexpr double kRounding = 1e-12;  // relative; the sphere's radius must not exclude a position on its surface

}  // namespace

PositionHierarchy::PositionHierarchy(std::vector<Eigen::Vector3d> positions) : positions_(std::move(positions)) {
  levels_.emplace_back();
  for (const auto& position : positions_) levels_[0].push_back({Eigen::AlignedBox3d(position)});
  for (std::size_t length = 2; levels_.back().size() > 1; length *= 2) {
    const auto& below = levels_.back();
    std::vector<Node> level;
    for (std::size_t i = 0; i < below.size(); i += 2) {
      Node parent = below[i];
      if (i + 1 < below.size()) parent.box.extend(below[i + 1].box);
      const std::size_t first = level.size() * length;
      for (std::size_t k = first; k < std::min(first + length, positions_.size()); ++k) {
        parent.radius = std::max(parent.radius, (positions_[k] - parent.box.center()).norm());
      }
      level.push_back(parent);
    }
    levels_.push_back(std::move(level));
  }
}

bool PositionHierarchy::MayLeave(std::size_t level, std::size_t node, const Eigen::Vector3d& center,
                                 double radius) const {
  if (level == 0) return (positions_[node] - center).norm() >= radius;
  const auto& [box, box_radius] = levels_[level][node];
  if ((box.center() - center).norm() + box_radius < (1.0 - kRounding) * radius) return false;
  const Eigen::Vector3d to_corner = (box.min() - center).cwiseAbs().cwiseMax((box.max() - center).cwiseAbs());
  return to_corner.norm() >= radius;
}

std::optional<std::size_t> PositionHierarchy::FirstOutside(std::size_t from, const Eigen::Vector3d& center,
                                                           double radius) const {
  std::size_t level = 0;
  std::size_t node = from;
  while (node < levels_[level].size()) {
    if (MayLeave(level, node, center, radius)) {
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

std::optional<std::size_t> PositionHierarchy::LastOutside(std::size_t from, const Eigen::Vector3d& center,
                                                          double radius) const {
  std::size_t level = 0;
  std::size_t end = from + 1;  // one past the node looked at
  while (end > 0) {
    if (MayLeave(level, end - 1, center, radius)) {
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
