#include "odometry/scale/track_points.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "evo/geometry/triangulation.hpp"

namespace evo::odometry {

namespace {

constexpr std::size_t kFewestViews = 3;
constexpr std::size_t kMostViews = 16;
constexpr double kSmallestResidualPx = 0.15;  // what smaller ones may hide
constexpr double kLargestResidualPx = 2.0;    // root mean square over a track

struct Sight {
  std::size_t place;  // in the segment
  const Feature* feature;
};

double PxPerUnit(const std::vector<Sight>& sights) {
  double sum = 0.0;
  for (const Sight& sight : sights) sum += std::sqrt(std::abs(sight.feature->J_pixel_normalized.determinant()));
  return sum / static_cast<double>(sights.size());
}

/// Root mean square on the plane z = 1.
double Residual(const std::vector<geometry::View>& views, const Eigen::Vector3d& position) {
  double sum = 0.0;
  for (const geometry::View& view : views) {
    const Eigen::Vector3d p = view.T_cam_world * position;
    sum += (p.head<2>() / p.z() - view.x).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(views.size()));
}

/// `before`: poses of earlier segments.
std::optional<TrackPoint> Triangulate(const std::vector<Sight>& sights, const Segment& segment, std::size_t before) {
  if (sights.size() < kFewestViews) return std::nullopt;
  std::vector<geometry::View> views;
  const std::size_t used = std::min(sights.size(), kMostViews);
  for (std::size_t k = 0; k < used; ++k) {
    const Sight& sight = sights[k * (sights.size() - 1) / (used - 1)];
    views.push_back({segment.T_cam_world[sight.place], sight.feature->x});
  }
  const auto point = geometry::TriangulateViews(views);
  if (!point) return std::nullopt;
  const double px_per_unit = PxPerUnit(sights);
  const double residual_px = Residual(views, point->position_world) * px_per_unit;
  if (!(residual_px < kLargestResidualPx)) return std::nullopt;
  // The errors along a track belong together, so that more views do not make it more certain: hence times their number.
  const double noise = std::hypot(residual_px, kSmallestResidualPx) / px_per_unit;
  return TrackPoint{before + sights.back().place, point->position_world,
                    noise * noise * static_cast<double>(used) * point->covariance};
}

}  // namespace

std::vector<TrackPoint> TriangulateTracks(const std::vector<Frame>& frames, const std::vector<Segment>& segments) {
  std::vector<TrackPoint> points;
  std::size_t before = 0;
  for (const Segment& segment : segments) {
    std::map<std::int64_t, std::vector<Sight>> tracks;
    for (std::size_t i = 0; i < segment.frames.size(); ++i) {
      for (const Feature& feature : frames[segment.frames[i]].features) tracks[feature.track].push_back({i, &feature});
    }
    for (const auto& [track, sights] : tracks) {
      if (const auto point = Triangulate(sights, segment, before)) points.push_back(*point);
    }
    before += segment.frames.size();
  }
  return points;
}

}  // namespace evo::odometry
