#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/core/time.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/geometry/trajectory.hpp"
#include "evo/io/depth_map_reader.hpp"

namespace evo::evaluation {

/// The observations of one feature, in order of time.
struct FeatureTrack {
  std::int64_t id = 0;
  std::vector<events::TrackObservation> observations;
};

/// In order of id.
std::vector<FeatureTrack> GroupById(const events::Tracks& tracks);

/// Whether a track can be compared with the truth, or why not.
enum class TrackVerdict {
  kJudged,
  kTooShort,         ///< fewer than two observations at which the true position is known
  kNoTruth,          ///< no true track of this id, or no pose, at any of its stamps
  kNoDepth,          ///< the depth where it begins is unknown or jumps there
  kMoves,            ///< begins on or beside something that moves by itself
  kNotTriangulated,  ///< its rays do not meet in one point in front of the cameras
};

/// How the point behind one track truly moved, in raw (distorted) sensor pixels.
struct TrueTrack {
  TrackVerdict verdict = TrackVerdict::kNoTruth;
  /// One for each observation of the track, at its stamp; empty where not known or not visible.
  std::vector<std::optional<Eigen::Vector2d>> positions;
  /// The same for the other surfaces around the place where it begins: a feature at the outline of a thing may be a
  /// mark on either side of it. As long as they are in the image, hidden or not.
  std::vector<std::vector<std::optional<Eigen::Vector2d>>> beside;
  /// The first known position is the track's own: the truth starts from it, and there is no error to see there.
  bool starts_at_observation = false;
  /// The last instant at which the point is seen; empty if that is not known.
  std::optional<TimeNs> visible_until;
};

struct TrackTruthOptions {
  double depth_edge = 0.1;        ///< neighbouring depths that differ by a larger share belong to different surfaces
  double surface_reach_px = 3.0;  ///< a feature may be on any surface this near to the place where it begins
};
void Register(Parameters& parameters, TrackTruthOptions& options);

// Three sources of truth. Each gives one TrueTrack for each of `tracks`, in their order. `max_gap`: the truth is
// interpolated between stamps that are no farther apart, and never extrapolated. The world must stand still where
// poses are used. All throw Error (kInput) when more than a fifth of the positions lie off the sensor or outside the
// lens model: tracks and calibration do not belong together.

/// A file of true tracks with the ids of the estimate, as rpg_feature_tracking_analysis makes them. It interpolates the
/// estimate at the stamps of the truth; here the truth is interpolated, linearly, at the stamps of the estimate.
std::vector<TrueTrack> TruthFromTracks(const std::vector<FeatureTrack>& tracks, const events::Tracks& truth,
                                       TimeNs max_gap);

/// Poses and depth maps: the point is where the ray of the first observation meets the surface in the depth map
/// nearest in time, and is projected into the camera at each later stamp. It is visible until it leaves the image or
/// lies behind the surface of a depth map, both looked for at the stamps of the maps. (The "reprojection" of
/// rpg_feature_tracking_analysis, there without lens distortion and occlusion.) Where the map tells what moves, tracks
/// that begin within `surface_reach_px` of such things are not judged.
/// Throws Error (kInput) where the maps have not the size of the sensor.
std::vector<TrueTrack> TruthFromDepth(const std::vector<FeatureTrack>& tracks, const geometry::Trajectory& trajectory,
                                      const geometry::Camera& camera, const io::DepthMapReader& maps, TimeNs max_gap,
                                      const TrackTruthOptions& options);

/// Poses alone: the point is triangulated from all observations of the track by least squares and projected back. What
/// is left is a lower bound of the error: the point follows a track that drifts, and drift along the epipolar lines
/// becomes depth. How long the point is visible stays unknown.
std::vector<TrueTrack> TruthFromTriangulation(const std::vector<FeatureTrack>& tracks,
                                              const geometry::Trajectory& trajectory, const geometry::Camera& camera,
                                              TimeNs max_gap);

}  // namespace evo::evaluation
