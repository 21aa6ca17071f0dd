#include "odometry/scale/driven_path.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace evo::odometry {

namespace {

constexpr double kNodesPerWindow = 10.0;
constexpr std::size_t kFewestNeighbours = 2;  // on either side
constexpr double kSmallestAcross = 1e-3;      // of a unit vector, that still tells a direction

Eigen::Vector3d Across(const Eigen::Vector3d& vector, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d across = vector - vector.dot(direction) * direction;
  return across.norm() > kSmallestAcross ? across.normalized() : vector.normalized();
}

}  // namespace

DrivenPath::DrivenPath(const std::vector<Eigen::Vector3d>& positions, const std::vector<Eigen::Vector3d>& down,
                       double window) {
  AddNodes(positions, down, window / kNodesPerWindow);
  Smooth(window);
}

/// Nodes lie a distance apart, not a time: a standing camera adds none.
void DrivenPath::AddNodes(const std::vector<Eigen::Vector3d>& positions, const std::vector<Eigen::Vector3d>& down,
                          double spacing) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    double step = nodes_.empty() ? 0.0 : (positions[i] - nodes_.back().position).norm();
    if (nodes_.empty() || step >= spacing) {
      nodes_.push_back({nodes_.empty() ? 0.0 : length() + step, positions[i], Eigen::Vector3d::Zero(), down[i]});
      step = 0.0;
    }
    node_of_.push_back(nodes_.size() - 1);
    along_.push_back(length() + step);
  }
}

/// A parabola through the positions around each node, which hills and bends fit; the mean of the directions down.
void DrivenPath::Smooth(double window) {
  const std::vector<Node> raw = nodes_;
  std::size_t begin = 0;
  std::size_t end = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    while (begin + kFewestNeighbours < i && raw[begin].along < node.along - window) ++begin;
    while (end < raw.size() && (end <= i + kFewestNeighbours || raw[end].along <= node.along + window)) ++end;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d right = Eigen::Matrix3d::Zero();
    Eigen::Vector3d down = Eigen::Vector3d::Zero();
    for (std::size_t j = begin; j < end; ++j) {
      const double u = (raw[j].along - node.along) / window;
      const Eigen::Vector3d powers(1.0, u, u * u);
      normal += powers * powers.transpose();
      right += powers * raw[j].position.transpose();
      down += raw[j].down;
    }
    if (end - begin < 3) continue;  // no direction: nothing is found beside it
    const Eigen::Matrix3d parabola = normal.ldlt().solve(right);
    node.position = parabola.row(0).transpose();
    node.forward = parabola.row(1).transpose().normalized();
    node.down = Across(down, node.forward);
  }
}

std::optional<PlaceByPath> DrivenPath::Locate(const Eigen::Vector3d& point, std::size_t pose, double reach) const {
  const auto ahead = [&](std::size_t node) { return (point - nodes_[node].position).dot(nodes_[node].forward); };
  std::size_t before = node_of_[pose];
  const double start = nodes_[before].along;
  // The last node that has the point ahead of it and a next one that has not.
  while (before > 0 && ahead(before) < 0.0 && start - nodes_[before].along < reach) --before;
  while (before + 1 < nodes_.size() && ahead(before + 1) >= 0.0 && nodes_[before].along - start < reach) ++before;
  if (before + 1 >= nodes_.size()) return std::nullopt;
  const double near = ahead(before);
  const double far = ahead(before + 1);
  if (!(near >= 0.0 && far < 0.0)) return std::nullopt;
  const Node& a = nodes_[before];
  const Node& b = nodes_[before + 1];
  const double s = near / (near - far);
  const Eigen::Vector3d offset = point - ((1.0 - s) * a.position + s * b.position);
  const Eigen::Vector3d forward = ((1.0 - s) * a.forward + s * b.forward).normalized();
  const Eigen::Vector3d down = Across((1.0 - s) * a.down + s * b.down, forward);
  return PlaceByPath{(1.0 - s) * a.along + s * b.along, offset.dot(down), offset.dot(down.cross(forward)), down};
}

}  // namespace evo::odometry
