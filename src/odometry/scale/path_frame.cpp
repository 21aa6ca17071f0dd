#include "odometry/scale/path_frame.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace evo::odometry {

namespace {

constexpr double kNodesPerWindow = 10.0;   // resolves the parabolas, and costs little
constexpr std::size_t kMinNeighbours = 2;  // on either side: three nodes define a parabola, five smooth one
constexpr std::size_t kMinParabolaNodes = 3;
constexpr double kMinNormal = 1e-3;  // length of a unit vector's part that still defines a direction

/// The unit vector of the part of `vector` that is normal to `direction`.
Eigen::Vector3d NormalPart(const Eigen::Vector3d& vector, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d normal = vector - vector.dot(direction) * direction;
  return normal.norm() > kMinNormal ? normal.normalized() : vector.normalized();
}

}  // namespace

PathFrame::PathFrame(const std::vector<Eigen::Vector3d>& positions, const std::vector<Eigen::Vector3d>& down,
                     double window) {
  AddNodes(positions, down, window / kNodesPerWindow);
  Smooth(window);
}

/// Nodes are equidistant in space, not in time: a standing camera adds none.
void PathFrame::AddNodes(const std::vector<Eigen::Vector3d>& positions, const std::vector<Eigen::Vector3d>& down,
                         double spacing) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    double step = nodes_.empty() ? 0.0 : (positions[i] - nodes_.back().position).norm();
    if (nodes_.empty() || step >= spacing) {
      nodes_.push_back({nodes_.empty() ? 0.0 : length() + step, positions[i], Eigen::Vector3d::Zero(), down[i]});
      step = 0.0;
    }
    last_nodes_.push_back(nodes_.size() - 1);
    arc_lengths_.push_back(length() + step);
  }
}

/// Position and tangent of a parabola through the positions around each node, which follows hills and curves; the mean
/// of the axes down (local regression; W. S. Cleveland, J. Amer. Statistical Association 1979).
void PathFrame::Smooth(double window) {
  const std::vector<Node> raw = nodes_;
  std::size_t begin = 0;
  std::size_t end = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    while (begin + kMinNeighbours < i && raw[begin].arc_length < node.arc_length - window) ++begin;
    while (end < raw.size() && (end <= i + kMinNeighbours || raw[end].arc_length <= node.arc_length + window)) ++end;
    Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d right_side = Eigen::Matrix3d::Zero();
    Eigen::Vector3d down = Eigen::Vector3d::Zero();
    for (std::size_t j = begin; j < end; ++j) {
      const double u = (raw[j].arc_length - node.arc_length) / window;
      const Eigen::Vector3d powers(1.0, u, u * u);
      normal_matrix += powers * powers.transpose();
      right_side += powers * raw[j].position.transpose();
      down += raw[j].down;
    }
    if (end - begin < kMinParabolaNodes) continue;  // without a tangent the node locates no point
    const Eigen::Matrix3d parabola = normal_matrix.ldlt().solve(right_side);
    node.position = parabola.row(0).transpose();
    node.forward = parabola.row(1).transpose().normalized();
    node.down = NormalPart(down, node.forward);
  }
}

std::optional<PathCoordinates> PathFrame::Locate(const Eigen::Vector3d& point, std::size_t pose,
                                                 double max_distance) const {
  const auto distance_ahead = [&](std::size_t node) {
    return (point - nodes_[node].position).dot(nodes_[node].forward);
  };
  std::size_t previous = last_nodes_[pose];
  const double start = nodes_[previous].arc_length;
  // The last node that has the point ahead of it while the next one has not.
  while (previous > 0 && distance_ahead(previous) < 0.0 && start - nodes_[previous].arc_length < max_distance) {
    --previous;
  }
  while (previous + 1 < nodes_.size() && distance_ahead(previous + 1) >= 0.0 &&
         nodes_[previous].arc_length - start < max_distance) {
    ++previous;
  }
  if (previous + 1 >= nodes_.size()) return std::nullopt;
  const double ahead_of_previous = distance_ahead(previous);
  const double ahead_of_next = distance_ahead(previous + 1);
  if (!(ahead_of_previous >= 0.0 && ahead_of_next < 0.0)) return std::nullopt;
  const Node& a = nodes_[previous];
  const Node& b = nodes_[previous + 1];
  const double s = ahead_of_previous / (ahead_of_previous - ahead_of_next);
  const Eigen::Vector3d offset = point - ((1.0 - s) * a.position + s * b.position);
  const Eigen::Vector3d forward = ((1.0 - s) * a.forward + s * b.forward).normalized();
  const Eigen::Vector3d down = NormalPart((1.0 - s) * a.down + s * b.down, forward);
  const double arc_length = (1.0 - s) * a.arc_length + s * b.arc_length;
  return PathCoordinates{arc_length, offset.dot(down), offset.dot(down.cross(forward)), down};
}

}  // namespace evo::odometry
