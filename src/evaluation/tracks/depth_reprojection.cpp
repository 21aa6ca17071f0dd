#include "evaluation/tracks/depth_reprojection.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace evo::evaluation {

namespace {

constexpr int kMaxDepthIterations = 50;     // the fixed-point iteration diverges on surfaces nearly along the ray
constexpr double kDepthTolerance = 1e-9;    // relative
constexpr int kMaxBisections = 30;          // from a second to a nanosecond
constexpr double kSameRayTolerance = 1e-6;  // on the plane z = 1

/// The four pixels around a position with their bilinear weights.
struct PixelNeighbours {
  std::array<double, 4> depth;
  std::array<double, 4> weight;
};

/// `pixel` must lie on the map, which has at least two rows and columns.
PixelNeighbours FindNeighbours(const events::DepthMap& map, const Eigen::Vector2d& pixel) {
  const int x = std::min(static_cast<int>(pixel.x()), map.width - 2);
  const int y = std::min(static_cast<int>(pixel.y()), map.height - 2);
  const double fx = pixel.x() - x;
  const double fy = pixel.y() - y;
  return {{map.At(x, y), map.At(x + 1, y), map.At(x, y + 1), map.At(x + 1, y + 1)},
          {(1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy}};
}

bool IsKnown(double depth) { return std::isfinite(depth) && depth > 0.0; }

}  // namespace

DepthReprojection::DepthReprojection(const geometry::Trajectory& trajectory, const geometry::Camera& camera,
                                     TimeNs max_gap, const TrackTruthOptions& options)
    : trajectory_(trajectory),
      camera_(camera),
      max_gap_(max_gap),
      depth_edge_ratio_(options.depth_edge_ratio),
      surface_radius_px_(options.surface_radius_px) {}

std::optional<geometry::SE3> DepthReprojection::CameraAt(TimeNs t) const {
  const auto T_world_cam = geometry::PoseAt(trajectory_, t, max_gap_);
  return T_world_cam ? std::optional(T_world_cam->Inverse()) : std::nullopt;
}

/// Fixed-point iteration for the point of the ray whose depth in the map's camera is the map's depth at its image.
std::optional<Eigen::Vector3d> DepthReprojection::IntersectSurface(const events::TrackObservation& observation,
                                                                   const geometry::SE3& T_cam_world,
                                                                   const DepthView& view) const {
  const Eigen::Vector2d pixel(observation.x, observation.y);
  const auto x = camera_.Contains(pixel) ? camera_.Undistort(pixel) : std::nullopt;
  if (!x) return std::nullopt;
  const geometry::SE3 T_world_cam = T_cam_world.Inverse();
  const geometry::SE3 T_map_cam = view.T_cam_world * T_world_cam;
  const Eigen::Vector3d ray = T_map_cam.rotation() * x->homogeneous();
  auto depth = SurfaceDepth(view.map, pixel);
  double z = depth.value_or(0.0);
  for (int i = 0; depth && i < kMaxDepthIterations; ++i) {
    const Eigen::Vector3d p = z * ray + T_map_cam.translation();
    const auto image = Project(p);
    depth = image ? SurfaceDepth(view.map, *image) : std::nullopt;
    if (!depth || !(ray.z() > 0.0)) return std::nullopt;
    const double change = (*depth - p.z()) / ray.z();
    z += change;
    if (std::abs(change) <= kDepthTolerance * z) return T_world_cam * (z * x->homogeneous());
  }
  return std::nullopt;
}

std::vector<Eigen::Vector3d> DepthReprojection::IntersectOtherSurfaces(const Eigen::Vector3d& position_world,
                                                                       const geometry::SE3& T_cam_world,
                                                                       const DepthView& view) const {
  const Eigen::Vector3d center = T_cam_world.Inverse().translation();
  const double center_depth = (view.T_cam_world * center).z();
  const double point_depth = (view.T_cam_world * position_world).z();
  std::vector<Eigen::Vector3d> points;
  for (const double depth : OtherSurfaceDepths(position_world, view)) {
    const double along = (depth - center_depth) / (point_depth - center_depth);
    if (along > 0.0) points.push_back(center + along * (position_world - center));
  }
  return points;
}

bool DepthReprojection::IsNearMovingObject(const Eigen::Vector3d& position_world, const DepthView& view) const {
  bool moves = false;
  VisitNeighbourhood(position_world, view, [&](int x, int y, double) { moves = moves || view.map.IsMoving(x, y); });
  return moves;
}

bool DepthReprojection::IsOccluded(const Eigen::Vector3d& position_world, const DepthView& view) const {
  const Eigen::Vector3d position_cam = view.T_cam_world * position_world;
  const auto pixel = Project(position_cam);
  if (!pixel) return false;
  double max_depth = 0.0;
  for (const double depth : FindNeighbours(view.map, *pixel).depth) {
    if (IsKnown(depth)) max_depth = std::max(max_depth, depth);
  }
  return max_depth > 0.0 && position_cam.z() > (1.0 + depth_edge_ratio_) * max_depth;
}

std::optional<Eigen::Vector2d> DepthReprojection::ProjectAt(const Eigen::Vector3d& position_world, TimeNs t) const {
  const auto T_cam_world = CameraAt(t);
  return T_cam_world ? Project(*T_cam_world * position_world) : std::nullopt;
}

TimeNs DepthReprojection::LastTimeInImage(const Eigen::Vector3d& position_world, TimeNs inside, TimeNs outside) const {
  for (int i = 0; i < kMaxBisections && outside - inside > 1; ++i) {
    const TimeNs middle = inside + (outside - inside) / 2;
    (ProjectAt(position_world, middle) ? inside : outside) = middle;
  }
  return inside;
}

std::optional<Eigen::Vector2d> DepthReprojection::Project(const Eigen::Vector3d& position_cam) const {
  if (!(position_cam.z() > 0.0)) return std::nullopt;
  const Eigen::Vector2d pixel = camera_.Project(position_cam);
  if (!camera_.Contains(pixel)) return std::nullopt;
  // Far outside its field of view a lens model may fold back onto the sensor.
  const auto x = camera_.Undistort(pixel);
  if (!x || (*x - position_cam.head<2>() / position_cam.z()).norm() > kSameRayTolerance * (1.0 + x->norm())) {
    return std::nullopt;
  }
  return pixel;
}

/// Calls visit(x, y, squared distance) for the pixels within the surface radius of a point's image.
template <typename Visitor>
void DepthReprojection::VisitNeighbourhood(const Eigen::Vector3d& position_world, const DepthView& view,
                                           const Visitor& visit) const {
  const auto image = Project(view.T_cam_world * position_world);
  if (!image) return;
  const double radius = std::max(surface_radius_px_, 1.0);
  const auto from = [&](double center) { return std::max(0, static_cast<int>(std::ceil(center - radius))); };
  const auto to = [&](double center, int size) {
    return std::min(size - 1, static_cast<int>(std::floor(center + radius)));
  };
  for (int y = from(image->y()); y <= to(image->y(), view.map.height); ++y) {
    for (int x = from(image->x()); x <= to(image->x(), view.map.width); ++x) {
      const double distance2 = (Eigen::Vector2d(x, y) - *image).squaredNorm();
      if (distance2 <= radius * radius) visit(x, y, distance2);
    }
  }
}

/// One depth for each surface other than the point's own, at the pixel nearest to the point's image.
std::vector<double> DepthReprojection::OtherSurfaceDepths(const Eigen::Vector3d& position_world,
                                                          const DepthView& view) const {
  if (!(surface_radius_px_ > 0.0)) return {};
  struct Pixel {
    double depth, distance2;
  };
  std::vector<Pixel> pixels;
  VisitNeighbourhood(position_world, view, [&](int x, int y, double distance2) {
    if (IsKnown(view.map.At(x, y))) pixels.push_back({view.map.At(x, y), distance2});
  });
  std::ranges::sort(pixels, {}, &Pixel::depth);
  const double own = (view.T_cam_world * position_world).z();
  std::vector<double> depths;
  for (auto begin = pixels.begin(), end = begin; begin != pixels.end(); begin = end) {
    for (++end; end != pixels.end() && end->depth <= (1.0 + depth_edge_ratio_) * (end - 1)->depth;) ++end;
    if (own >= begin->depth / (1.0 + depth_edge_ratio_) && own <= (1.0 + depth_edge_ratio_) * (end - 1)->depth) {
      continue;
    }
    depths.push_back(std::ranges::min_element(begin, end, {}, &Pixel::distance2)->depth);
  }
  return depths;
}

/// Interpolated in inverse depth, which is linear on a plane. Empty if unknown or across a depth edge.
std::optional<double> DepthReprojection::SurfaceDepth(const events::DepthMap& map, const Eigen::Vector2d& pixel) const {
  const PixelNeighbours neighbours = FindNeighbours(map, pixel);
  if (!std::ranges::all_of(neighbours.depth, IsKnown)) return std::nullopt;
  if (std::ranges::max(neighbours.depth) > (1.0 + depth_edge_ratio_) * std::ranges::min(neighbours.depth)) {
    return std::nullopt;
  }
  double inverse = 0.0;
  for (std::size_t i = 0; i < neighbours.depth.size(); ++i) inverse += neighbours.weight[i] / neighbours.depth[i];
  return 1.0 / inverse;
}

}  // namespace evo::evaluation
