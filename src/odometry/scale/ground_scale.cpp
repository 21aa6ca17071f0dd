#include "odometry/scale/ground_scale.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "evo/core/median.hpp"
#include "odometry/scale/height_profile.hpp"
#include "odometry/scale/path_frame.hpp"
#include "odometry/scale/triangulated_track.hpp"

namespace evo::odometry {

namespace {

constexpr double kInitialWindow = 0.1;         // over the typical distance of the tracks, before the height is known
constexpr double kWindow = 3.0;                // heights to either side that the path is smoothed over
constexpr double kDriftWindow = 8.0;           // heights that the scale is averaged over to measure its drift
constexpr double kDriftOverCovariance = 0.45;  // measured: near that of the covariance before its inflation
constexpr double kUnknownScaleDrift = 0.002;   // over a path of one height, without a covariance of the poses
constexpr double kMaxDistance = 40.0;  // heights of arc length from the camera that observes a track to the track

/// All poses of a run in order of time.
struct CameraPath {
  std::vector<Eigen::Vector3d> positions;   // world
  std::vector<Eigen::Vector3d> down;        // the camera's y axis, world
  std::vector<std::size_t> segment_begins;  // first pose of every segment
};

CameraPath ListPoses(const std::vector<Segment>& segments) {
  CameraPath path;
  for (const Segment& segment : segments) {
    path.segment_begins.push_back(path.positions.size());
    for (const SegmentPose& pose : segment.poses) {
      const geometry::SE3 T_world_cam = pose.T_cam_world.Inverse();
      path.positions.push_back(T_world_cam.translation());
      path.down.push_back(T_world_cam.rotation() * Eigen::Vector3d::UnitY());
    }
  }
  return path;
}

double MedianDistance(const std::vector<TriangulatedTrack>& tracks, const CameraPath& path) {
  std::vector<double> distances;
  distances.reserve(tracks.size());
  for (const auto& track : tracks) distances.push_back((track.position - path.positions[track.last_pose]).norm());
  return Median(std::move(distances));
}

/// The tracks below the path, at most `max_lateral_ratio` of the depth to the side: farther out there are hardly any on
/// the road, and they depend on its roll.
std::vector<GroundObservation> FindGroundObservations(const PathFrame& path_frame,
                                                      const std::vector<TriangulatedTrack>& tracks, double max_distance,
                                                      double max_lateral_ratio) {
  std::vector<GroundObservation> observations;
  for (const TriangulatedTrack& track : tracks) {
    const auto place = path_frame.Locate(track.position, track.last_pose, max_distance);
    if (!place || !(place->below > 0.0) || std::abs(place->right) > max_lateral_ratio * place->below) continue;
    const double inverse = 1.0 / place->below;
    const double sigma = std::sqrt(place->down.dot(track.covariance * place->down));
    observations.push_back({place->arc_length, inverse, sigma * inverse * inverse, place->right * inverse});
  }
  return observations;
}

struct PathHeights {
  std::vector<double> inverse_heights;  // at every pose
  HeightProfile profile;
  double scale_drift_ratio = 0.0;  // of the relative scale over a path of one height
};

/// The drift of the scale that the tracks leave, as GroundOptions::scale_drift_ratio.
double ScaleDriftRatio(const GroundOptions& options, const std::vector<Segment>& segments, double height) {
  if (options.scale_drift_ratio > 0.0) return options.scale_drift_ratio;
  double ratio = 0.0;
  for (const Segment& segment : segments) {
    ratio = std::max(ratio, segment.uncertainty.ScaleDrift(kDriftWindow * height) * std::sqrt(height));
  }
  return ratio > 0.0 ? kDriftOverCovariance * ratio : kUnknownScaleDrift;
}

/// In two rounds: the path is smoothed over a few heights, which have to be known roughly for that.
std::optional<PathHeights> MeasureHeights(const GroundOptions& options, const std::vector<TriangulatedTrack>& tracks,
                                          const CameraPath& path, const std::vector<Segment>* segments) {
  double window = kInitialWindow * MedianDistance(tracks, path);
  PathHeights heights;
  for (int round = 0; round < 2; ++round) {
    if (!(window > 0.0)) return std::nullopt;
    const PathFrame path_frame(path.positions, path.down, window);
    const double height = window / kWindow;
    heights.scale_drift_ratio = ScaleDriftRatio(options, *segments, height);
    HeightProfileOptions profile_options{
        heights.scale_drift_ratio / std::sqrt(height), options.roll_drift, path_frame.length(), {}};
    for (std::size_t i = 1; i < path.segment_begins.size(); ++i) {
      profile_options.scale_breaks.push_back(path_frame.arc_length(path.segment_begins[i]));
    }
    const auto observations =
        FindGroundObservations(path_frame, tracks, kMaxDistance / kWindow * window, options.max_lateral_ratio);
    auto profile = FitHeightProfile(profile_options, observations);
    if (!profile) return std::nullopt;
    heights.profile = std::move(*profile);
    heights.inverse_heights.clear();
    for (std::size_t i = 0; i < path.positions.size(); ++i) {
      heights.inverse_heights.push_back(heights.profile.InverseHeight(path_frame.arc_length(i)));
    }
    window = kWindow / heights.profile.InverseHeight(0.5 * path_frame.length());
  }
  return heights;
}

/// Moves each point with the nearest of the poses that observe its track; `old_poses` and `scales` are of all poses of
/// the segment.
void MovePoints(const std::vector<Frame>& frames, const std::vector<geometry::SE3>& old_poses,
                const std::vector<double>& scales, Segment* segment) {
  std::unordered_map<std::int64_t, std::vector<std::size_t>> observing_poses;
  for (const Point& point : segment->points) observing_poses[point.track];
  for (std::size_t i = 0; i < segment->poses.size(); ++i) {
    for (const Feature& feature : frames[segment->poses[i].frame].features) {
      const auto found = observing_poses.find(feature.track);
      if (found != observing_poses.end()) found->second.push_back(i);
    }
  }
  for (Point& point : segment->points) {
    auto& poses = observing_poses[point.track];
    if (poses.empty()) poses.push_back(0);
    const auto distance = [&](std::size_t i) { return (old_poses[i] * point.position).norm(); };
    const std::size_t nearest = *std::ranges::min_element(poses, {}, distance);
    point.position =
        segment->poses[nearest].T_cam_world.Inverse() * (scales[nearest] * (old_poses[nearest] * point.position));
  }
}

std::vector<geometry::SE3> CollectPoses(const Segment& segment) {
  std::vector<geometry::SE3> T_cam_world;
  for (const SegmentPose& pose : segment.poses) T_cam_world.push_back(pose.T_cam_world);
  return T_cam_world;
}

/// Multiplies every step from pose to pose by the scale there; `scales` are of all poses of the run, `information` is
/// in the new unit.
void Rescale(const std::vector<double>& scales, const ScaleInformation& information, const std::vector<Frame>& frames,
             std::vector<Segment>* segments) {
  std::size_t pose = 0;
  Eigen::Vector3d old_position = Eigen::Vector3d::Zero();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (Segment& segment : *segments) {
    const std::vector<geometry::SE3> old_poses = CollectPoses(segment);
    std::vector<double> segment_scales;
    for (SegmentPose& segment_pose : segment.poses) {
      const geometry::SE3 T_world_cam = segment_pose.T_cam_world.Inverse();
      const double scale = 0.5 * (scales[pose == 0 ? 0 : pose - 1] + scales[pose]);
      position += scale * (T_world_cam.translation() - old_position);
      old_position = T_world_cam.translation();
      segment_pose.T_cam_world = geometry::SE3(T_world_cam.rotation(), position).Inverse();
      segment_scales.push_back(scales[pose]);
      ++pose;
    }
    segment.uncertainty.ApplyScale(information, segment_scales, CollectPoses(segment));
    MovePoints(frames, old_poses, segment_scales, &segment);
  }
}

}  // namespace

GroundScale ScaleByGround(const GroundOptions& options, const std::vector<Frame>& frames,
                          std::vector<Segment>* segments) {
  const auto heights = MeasureHeights(options, TriangulateTracks(frames, *segments), ListPoses(*segments), segments);
  const bool is_metric = options.camera_height_m > 0.0;
  if (!heights || (!is_metric && heights->profile.path_length_in_heights < options.min_path_heights)) {
    spdlog::log(is_metric ? spdlog::level::warn : spdlog::level::info,
                "odometry: no ground found below the path: the scale stays arbitrary and may drift");
    return {};
  }
  const double height = is_metric ? options.camera_height_m : 1.0 / Median(heights->inverse_heights);
  std::vector<double> scales;
  for (const double inverse_height : heights->inverse_heights) scales.push_back(height * inverse_height);
  const HeightProfileQuality& quality = heights->profile.quality;
  // Tracks on a road err together: on simulated drives lengths come out too short by the common ratio.
  const double sigma = std::hypot(quality.relative_sigma, options.common_sigma_ratio);
  // A random walk that is smoothed to this standard deviation has errors correlated over this many heights.
  const double correlation_heights =
      std::max(2.0 * kWindow, 2.0 * std::pow(quality.relative_sigma / heights->scale_drift_ratio, 2));
  Rescale(scales, {sigma, height * correlation_heights}, frames, segments);
  const auto [min_scale, max_scale] = std::ranges::minmax(scales);
  spdlog::info(
      "odometry: scale from the ground: {:.4g} to {:.4g} {} a unit along the path, {} tracks, {:.0f} % of the path "
      "covered, uncertain by {:.2f} %",
      min_scale, max_scale, is_metric ? "m" : "new units", quality.inliers, 100.0 * quality.covered_ratio,
      100.0 * quality.relative_sigma);
  return {true, is_metric, quality.inliers, quality.covered_ratio, quality.relative_sigma, min_scale, max_scale};
}

}  // namespace evo::odometry
