#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/evaluation/evaluation_options.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/geometry/trajectory.hpp"
#include "evo/io/depth_map_reader.hpp"

namespace evo::evaluation {

/// The observations of one feature in order of time.
struct FeatureTrack {
  std::int64_t id = 0;
  std::vector<events::TrackObservation> observations;
};

/// Groups observations by feature, in order of id.
std::vector<FeatureTrack> GroupById(const events::Tracks& tracks);

/// Whether a track is evaluated, or why not.
enum class TrackStatus {
  kEvaluated,
  kTooShort,         ///< fewer than two observations have a true position
  kNoTruth,          ///< no true track of this id, or no pose, at any of its stamps
  kNoDepth,          ///< the depth at its start is unknown or discontinuous
  kMovingObject,     ///< starts on or next to a moving object
  kNotTriangulated,  ///< its rays do not meet in a point in front of the cameras
};

/// One position for each observation of a track, at its stamp; empty where unknown.
using TruePositions = std::vector<std::optional<Eigen::Vector2d>>;

/// The true motion of the point behind one track, in raw (distorted) sensor pixels.
struct TrueTrack {
  TrackStatus status = TrackStatus::kNoTruth;
  TruePositions positions;  ///< empty where unknown or not visible
  /// Positions of points on the other surfaces around the track's start, because a feature at an occluding contour may
  /// be a texture on either side of it. They are known while they are in the image, occluded or not.
  std::vector<TruePositions> other_surfaces;
  /// The truth starts from the track's own first position, so that position has no error.
  bool starts_at_observation = false;
  std::optional<TimeNs> visible_until;  ///< last instant at which the point is visible; empty if unknown
};

// Three sources of truth. Each returns one TrueTrack for each of `tracks`, in their order. The truth is interpolated
// between stamps at most `max_gap` apart and never extrapolated. Sources with poses assume a static world. They throw
// Error (kInput) if more than a fifth of the positions lie off the sensor or outside the lens model, because tracks and
// calibration then do not belong together.

/// From a file of true tracks with the ids of the estimate, as rpg_feature_tracking_analysis makes them. That program
/// interpolates the estimate at the stamps of the truth; here the truth is interpolated at the stamps of the estimate.
std::vector<TrueTrack> TruthFromTracks(const std::vector<FeatureTrack>& tracks, const events::Tracks& truth,
                                       TimeNs max_gap);

/// From poses and depth maps, the "reprojection" of rpg_feature_tracking_analysis with lens distortion and occlusion:
/// the ray of the first observation meets the surface of the depth map nearest in time, and that point is projected
/// into the camera at each later stamp. The point is visible until it leaves the image or lies behind the surface of a
/// depth map, both tested at the stamps of the maps. If the maps mark moving objects, tracks that start within
/// `surface_radius_px` of one are not evaluated. Throws Error (kInput) if the maps and the sensor differ in size.
std::vector<TrueTrack> TruthFromDepth(const std::vector<FeatureTrack>& tracks, const geometry::Trajectory& trajectory,
                                      const geometry::Camera& camera, const io::DepthMapReader& maps, TimeNs max_gap,
                                      const TrackTruthOptions& options);

/// From poses alone: the point is triangulated from all observations of the track by least squares and projected back.
/// The residual is a lower bound of the error, because the point follows a drifting track and drift along the epipolar
/// lines becomes depth. The time of visibility stays unknown.
std::vector<TrueTrack> TruthFromTriangulation(const std::vector<FeatureTrack>& tracks,
                                              const geometry::Trajectory& trajectory, const geometry::Camera& camera,
                                              TimeNs max_gap);

}  // namespace evo::evaluation
