#include "odometry/scale/triangulated_track.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "evo/geometry/triangulation.hpp"

namespace evo::odometry {

namespace {

constexpr std::size_t kMinViews = 3;       // two have hardly a residual
constexpr std::size_t kMaxViews = 16;      // spread over the track: more do not make it more certain
constexpr double kResidualFloorPx = 0.15;  // error that residuals may not show
constexpr double kMaxResidualPx = 2.0;     // root mean square over a track: beyond, it does not belong to a fixed point

struct TrackObservation {
  std::size_t pose;  // index in the segment
  const Feature* feature;
};

/// Mean number of pixels to a unit on the plane z = 1.
double MeanPixelScale(const std::vector<TrackObservation>& observations) {
  double sum = 0.0;
  for (const TrackObservation& observation : observations) {
    sum += std::sqrt(std::abs(observation.feature->J_pixel_normalized.determinant()));
  }
  return sum / static_cast<double>(observations.size());
}

/// Root mean square on the plane z = 1.
double RmsResidual(const std::vector<geometry::View>& views, const Eigen::Vector3d& position) {
  double sum = 0.0;
  for (const geometry::View& view : views) {
    const Eigen::Vector3d p = view.T_cam_world * position;
    sum += (p.head<2>() / p.z() - view.x).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(views.size()));
}

/// `first_pose` is the number of poses in earlier segments.
std::optional<TriangulatedTrack> Triangulate(const std::vector<TrackObservation>& observations, const Segment& segment,
                                             std::size_t first_pose) {
  if (observations.size() < kMinViews) return std::nullopt;
  std::vector<geometry::View> views;
  const std::size_t used = std::min(observations.size(), kMaxViews);
  for (std::size_t k = 0; k < used; ++k) {
    const TrackObservation& observation = observations[k * (observations.size() - 1) / (used - 1)];
    views.push_back({segment.poses[observation.pose].T_cam_world, observation.feature->x});
  }
  const auto point = geometry::TriangulateViews(views);
  if (!point) return std::nullopt;
  const double pixel_scale = MeanPixelScale(observations);
  const double residual_px = RmsResidual(views, point->position_world) * pixel_scale;
  if (!(residual_px < kMaxResidualPx)) return std::nullopt;
  // The errors within a track are correlated, so that more views do not make it more certain: times their number.
  const double sigma = std::hypot(residual_px, kResidualFloorPx) / pixel_scale;
  return TriangulatedTrack{first_pose + observations.back().pose, point->position_world,
                           sigma * sigma * static_cast<double>(used) * point->covariance};
}

}  // namespace

std::vector<TriangulatedTrack> TriangulateTracks(const std::vector<Frame>& frames,
                                                 const std::vector<Segment>& segments) {
  std::vector<TriangulatedTrack> triangulated;
  std::size_t first_pose = 0;
  for (const Segment& segment : segments) {
    std::map<std::int64_t, std::vector<TrackObservation>> tracks;
    for (std::size_t i = 0; i < segment.poses.size(); ++i) {
      for (const Feature& feature : frames[segment.poses[i].frame].features) {
        tracks[feature.track].push_back({i, &feature});
      }
    }
    for (const auto& [track, observations] : tracks) {
      if (const auto point = Triangulate(observations, segment, first_pose)) triangulated.push_back(*point);
    }
    first_pose += segment.poses.size();
  }
  return triangulated;
}

}  // namespace evo::odometry
