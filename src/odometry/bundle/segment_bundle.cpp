#include "odometry/bundle/segment_bundle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "evo/geometry/triangulation.hpp"
#include "odometry/bundle/block_skyline_matrix.hpp"

namespace evo::odometry {

namespace {

constexpr std::size_t kMinObservations = 3;  // of a track: two always fit a point nearly
// Lengths in frames of the pieces that a track is cut into, tried in turn until the adjustment is affordable. Even the
// first is finite: the drift of a longer track bends the path more than its length straightens it.
constexpr std::array kPieceLengths = {50, 35, 25};
constexpr std::size_t kMinFeaturesToCut = 50;         // in a frame: fewer tracks are all needed at their whole length
constexpr double kGoldenSection = 0.618033988749895;  // spreads the cuts of consecutive tracks evenly over the frames
constexpr std::size_t kTriangulationViews = 8;
constexpr double kFarDepthRatio = 1e-3;  // inverse depth of a track without parallax over the mean one

/// Indices of the segment's poses that are at least so much image motion apart.
std::vector<std::size_t> FindMovingPoses(const std::vector<Frame>& frames, const Segment& segment,
                                         double min_disparity_px) {
  const auto frame_of = [&](std::size_t i) -> const Frame& { return frames[segment.poses[i].frame]; };
  std::vector<std::size_t> moving = {0};
  for (std::size_t i = 1; i < segment.poses.size(); ++i) {
    const auto pairs = Match(frame_of(moving.back()), frame_of(i));
    if (pairs.empty() || MedianDisparity(pairs) >= min_disparity_px) moving.push_back(i);
  }
  return moving;
}

/// Every n-th element and the last.
std::vector<std::size_t> ThinOut(const std::vector<std::size_t>& indices, std::size_t n) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < indices.size(); i += n) kept.push_back(indices[i]);
  if (kept.back() != indices.back()) kept.push_back(indices.back());
  return kept;
}

struct TrackObservation {
  int frame;  // index of the problem's pose
  const Feature* feature;
};

/// A track, or one piece of a long one.
struct TrackPiece {
  std::int64_t track;
  std::vector<TrackObservation> observations;
};

/// Triangulates a piece from some of its observations; at the inverse depth `far_inverse_depth` if that fails.
BundlePoint InitializePoint(const std::vector<TrackObservation>& observations, const std::vector<geometry::SE3>& poses,
                            double far_inverse_depth) {
  std::vector<geometry::View> views;
  const std::size_t used = std::min(observations.size(), kTriangulationViews);
  for (std::size_t k = 0; k < used; ++k) {
    const TrackObservation& observation = observations[k * (observations.size() - 1) / (used - 1)];
    views.push_back({poses[observation.frame], observation.feature->x});
  }
  const geometry::SE3& T_anchor_world = poses[observations.front().frame];
  const Eigen::Vector2d& x = observations.front().feature->x;
  const auto point = geometry::TriangulateViews(views);
  const double z = point ? (T_anchor_world * point->position_world).z() : 0.0;
  return {observations.front().frame, {x.x(), x.y(), z > 0.0 ? 1.0 / z : far_inverse_depth}};
}

/// All tracks in these poses of the segment, cut into pieces of `piece_length` frames, each track at other frames, so
/// that no frame loses the connection to its neighbours.
std::vector<TrackPiece> CutTracks(const std::vector<Frame>& frames, const Segment& segment,
                                  const std::vector<std::size_t>& segment_poses, int piece_length) {
  std::vector<TrackPiece> pieces;
  std::unordered_map<std::int64_t, std::size_t> present_pieces;  // of each track
  for (std::size_t k = 0; k < segment_poses.size(); ++k) {
    const Frame& frame = frames[segment.poses[segment_poses[k]].frame];
    const int index = static_cast<int>(k);
    const bool may_cut = frame.features.size() >= kMinFeaturesToCut;
    for (const Feature& feature : frame.features) {
      const auto [present, is_new] = present_pieces.try_emplace(feature.track, pieces.size());
      const int shift =
          static_cast<int>(piece_length * std::fmod(kGoldenSection * static_cast<double>(feature.track), 1.0));
      const auto number = [&](int f) { return (f + shift) / piece_length; };
      if (is_new || (may_cut && number(index) != number(pieces[present->second].observations.front().frame))) {
        present->second = pieces.size();
        pieces.push_back({feature.track, {}});
      }
      pieces[present->second].observations.push_back({index, &feature});
    }
  }
  return pieces;
}

SegmentBundle BuildBundle(const std::vector<Frame>& frames, const Segment& segment,
                          const std::vector<std::size_t>& segment_poses, int piece_length, double far_inverse_depth) {
  SegmentBundle bundle;
  bundle.segment_poses = segment_poses;
  for (const std::size_t i : segment_poses) bundle.problem.T_cam_world.push_back(segment.poses[i].T_cam_world);
  for (const auto& [track, observations] : CutTracks(frames, segment, segment_poses, piece_length)) {
    if (observations.size() < kMinObservations) continue;
    const int point = static_cast<int>(bundle.track_ids.size());
    bundle.track_ids.push_back(track);
    bundle.problem.points.push_back(InitializePoint(observations, bundle.problem.T_cam_world, far_inverse_depth));
    for (const auto& [frame, feature] : observations) {
      bundle.problem.observations.push_back({frame, point, feature->x, feature->J_pixel_normalized});
    }
  }
  return bundle;
}

/// The pose farthest from the first one: its distance holds the scale best.
int FindFarthestPose(const BundleProblem& problem) {
  const geometry::SE3 T_world_first = problem.T_cam_world.front().Inverse();
  const auto farthest = std::ranges::max_element(problem.T_cam_world, {}, [&](const geometry::SE3& T_cam_world) {
    return (T_cam_world * T_world_first).translation().norm();
  });
  return static_cast<int>(farthest - problem.T_cam_world.begin());
}

double MeanInverseDepth(const Segment& segment) {
  double mean = 0.0;
  for (const Point& point : segment.points) {
    const double distance = (segment.poses.front().T_cam_world * point.position).norm();
    mean += 1.0 / std::max(distance, 1e-9) / static_cast<double>(segment.points.size());
  }
  return mean;
}

}  // namespace

SegmentBundle BuildSegmentBundle(const FinalRefinementOptions& options, const std::vector<Frame>& frames,
                                 const Segment& segment) {
  const double far_inverse_depth = kFarDepthRatio * MeanInverseDepth(segment);
  const auto moving = FindMovingPoses(frames, segment, options.min_disparity_px);
  for (std::size_t n = 1;; ++n) {
    for (const int piece_length : kPieceLengths) {
      SegmentBundle bundle = BuildBundle(frames, segment, ThinOut(moving, n), piece_length, far_inverse_depth);
      bundle.problem.scale_frame = FindFarthestPose(bundle.problem);
      const double products = BlockSkylineMatrix::CountBlockProducts(ReducedSystemSkyline(bundle.problem));
      if (products <= options.max_block_products || bundle.segment_poses.size() <= 2) return bundle;
    }
  }
}

}  // namespace evo::odometry
