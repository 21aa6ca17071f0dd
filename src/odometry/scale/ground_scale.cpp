#include "odometry/scale/ground_scale.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "evo/core/median.hpp"
#include "odometry/scale/driven_path.hpp"
#include "odometry/scale/ground_profile.hpp"
#include "odometry/scale/track_points.hpp"

namespace evo::odometry {

namespace {

constexpr double kFirstWindow = 0.1;  // of the usual distance of the tracks, while the height is not known yet
constexpr double kWindow = 3.0;       // heights to either side that the path is smoothed over
constexpr double kReach = 40.0;       // heights between the camera that saw a track and its place by the path
// Sideways over below, of tracks that may lie on the ground. Farther to the side there are kerbs and parked cars, and
// near the image's border the tracks of a road drift outwards.
constexpr double kCone = 0.8;
// What the scale errs by besides, since tracks on a road err alike: on simulated drives lengths come out so much short.
constexpr double kErrAlike = 0.005;
constexpr double kShortestDrive = 10.0;  // heights, from where on a height that is not known is taken for constant

/// All poses of a run in order of time.
struct PoseList {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> down;  // the camera's y axis
  std::vector<std::size_t> begins;    // of the segments
};

PoseList ListPoses(const std::vector<Segment>& segments) {
  PoseList list;
  for (const Segment& segment : segments) {
    list.begins.push_back(list.positions.size());
    for (const geometry::SE3& T_cam_world : segment.T_cam_world) {
      const geometry::SE3 T_world_cam = T_cam_world.Inverse();
      list.positions.push_back(T_world_cam.translation());
      list.down.push_back(T_world_cam.rotation() * Eigen::Vector3d::UnitY());
    }
  }
  return list;
}

double UsualDistance(const std::vector<TrackPoint>& points, const PoseList& poses) {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const auto& point : points) distances.push_back((point.position - poses.positions[point.pose]).norm());
  return Median(std::move(distances));
}

std::vector<GroundSighting> FindBelow(const DrivenPath& path, const std::vector<TrackPoint>& points, double reach) {
  std::vector<GroundSighting> sightings;
  for (const TrackPoint& point : points) {
    const auto place = path.Locate(point.position, point.pose, reach);
    if (!place || !(place->below > 0.0) || std::abs(place->sideways) > kCone * place->below) continue;
    const double inverse = 1.0 / place->below;
    const double sigma = std::sqrt(place->down.dot(point.covariance * place->down));
    sightings.push_back({place->along, inverse, sigma * inverse * inverse, place->sideways * inverse});
  }
  return sightings;
}

/// One over the height at every pose.
struct PoseHeights {
  std::vector<double> inverse;
  GroundProfile profile;
};

/// Twice: the path has to be smoothed over some heights, so these have to be known roughly first.
std::optional<PoseHeights> MeasureHeights(const GroundOptions& options, const std::vector<TrackPoint>& points,
                                          const PoseList& poses) {
  double window = kFirstWindow * UsualDistance(points, poses);
  PoseHeights heights;
  for (int round = 0; round < 2; ++round) {
    if (!(window > 0.0)) return std::nullopt;
    const DrivenPath path(poses.positions, poses.down, window);
    GroundProfileOptions profile_options{options.scale_drift_ratio, path.length(), {}};
    for (std::size_t i = 1; i < poses.begins.size(); ++i) {
      profile_options.breaks.push_back(path.Along(poses.begins[i]));
    }
    auto profile = FitGround(profile_options, FindBelow(path, points, kReach / kWindow * window));
    if (!profile) return std::nullopt;
    heights.profile = std::move(*profile);
    heights.inverse.clear();
    for (std::size_t i = 0; i < poses.positions.size(); ++i) {
      heights.inverse.push_back(heights.profile.InverseHeight(path.Along(i)));
    }
    window = kWindow / heights.profile.InverseHeight(0.5 * path.length());
  }
  return heights;
}

/// Moves each point with the nearest of the poses that see its track; `scales` are those of the segment's poses.
void MovePoints(const std::vector<Frame>& frames, const std::vector<geometry::SE3>& old_poses,
                const std::vector<double>& scales, Segment* segment) {
  std::unordered_map<std::int64_t, std::vector<std::size_t>> seen_in;
  for (const Point& point : segment->points) seen_in[point.track];
  for (std::size_t i = 0; i < segment->frames.size(); ++i) {
    for (const Feature& feature : frames[segment->frames[i]].features) {
      const auto found = seen_in.find(feature.track);
      if (found != seen_in.end()) found->second.push_back(i);
    }
  }
  for (Point& point : segment->points) {
    auto& places = seen_in[point.track];
    if (places.empty()) places.push_back(0);
    const auto distance = [&](std::size_t i) { return (old_poses[i] * point.position).norm(); };
    const std::size_t nearest = *std::ranges::min_element(places, {}, distance);
    point.position =
        segment->T_cam_world[nearest].Inverse() * (scales[nearest] * (old_poses[nearest] * point.position));
  }
}

/// Every step from pose to pose with the scale that holds there, see PoseUncertainty::HoldScale; `reach` is in the new
/// unit.
void Rescale(const std::vector<double>& scales, double error, double reach, const std::vector<Frame>& frames,
             std::vector<Segment>* segments) {
  std::size_t pose = 0;
  Eigen::Vector3d old_position = Eigen::Vector3d::Zero();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (Segment& segment : *segments) {
    const std::vector<geometry::SE3> old_poses = segment.T_cam_world;
    const auto begin = scales.begin() + static_cast<std::ptrdiff_t>(pose);
    for (std::size_t i = 0; i < segment.besides.size(); ++i) {
      const double scale = begin[static_cast<std::ptrdiff_t>(i)];
      segment.besides[i].topRows<3>() *= scale;
      segment.besides[i].leftCols<3>() *= scale;
    }
    for (geometry::SE3& T_cam_world : segment.T_cam_world) {
      const geometry::SE3 T_world_cam = T_cam_world.Inverse();
      const double scale = 0.5 * (scales[pose == 0 ? 0 : pose - 1] + scales[pose]);
      position += scale * (T_world_cam.translation() - old_position);
      old_position = T_world_cam.translation();
      T_cam_world = geometry::SE3(T_world_cam.rotation(), position).Inverse();
      ++pose;
    }
    std::vector<geometry::SE3> adjusted;
    for (const std::size_t i : segment.adjusted) adjusted.push_back(segment.T_cam_world[i]);
    segment.uncertainty.HoldScale(adjusted, error, reach);
    MovePoints(frames, old_poses, {begin, scales.begin() + static_cast<std::ptrdiff_t>(pose)}, &segment);
  }
}

}  // namespace

GroundScale ScaleByGround(const GroundOptions& options, const std::vector<Frame>& frames,
                          std::vector<Segment>* segments) {
  const auto heights = MeasureHeights(options, TriangulateTracks(frames, *segments), ListPoses(*segments));
  const bool known = options.camera_height_m > 0.0;
  if (!heights || (!known && heights->profile.heights < kShortestDrive)) {
    spdlog::log(known ? spdlog::level::warn : spdlog::level::info,
                "odometry: no ground found below the path: the scale stays arbitrary and may drift");
    return {};
  }
  const double height = known ? options.camera_height_m : 1.0 / Median(heights->inverse);
  std::vector<double> scales;
  for (const double inverse : heights->inverse) scales.push_back(height * inverse);
  const GroundProfile& profile = heights->profile;
  // A random walk that is smoothed to an error of so much errs alike over so long a way.
  const double reach = height * std::max(2.0 * kWindow, 2.0 * std::pow(profile.error / options.scale_drift_ratio, 2));
  Rescale(scales, std::hypot(profile.error, kErrAlike), reach, frames, segments);
  const auto [lowest, highest] = std::ranges::minmax(scales);
  const GroundScale scale{true, known, profile.tracks, profile.covered, profile.error, lowest, highest};
  spdlog::info(
      "odometry: scale from the ground: {:.4g} to {:.4g} {} a unit along the path, {} tracks, {:.0f} % of the path "
      "covered, uncertain by {:.2f} %",
      scale.lowest, scale.highest, known ? "m" : "new units", scale.tracks, 100.0 * scale.covered, 100.0 * scale.error);
  return scale;
}

}  // namespace evo::odometry
