#include "odometry/bundle/run_bundle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "evo/geometry/triangulation.hpp"
#include "odometry/bundle/block_skyline.hpp"

namespace evo::odometry {

namespace {

constexpr std::size_t kFewestSightings = 3;  // of a track that takes part
// Frames after which a track counts as a new one, tried in turn until the adjustment is affordable. Even the first is
// finite: the drift of a long track bends the path more than its length straightens it.
constexpr std::array kSpans = {50, 35, 25};
constexpr std::size_t kCrowd = 50;  // tracks in a frame from which on some may be cut: few tracks need their length
constexpr double kGoldenSection = 0.618033988749895;
constexpr std::size_t kTriangulationViews = 8;
constexpr double kFarShare = 1e-3;  // inverse depth of a track without parallax, of the usual one

/// Places in the segment of frames that lie at least so much image motion apart.
std::vector<std::size_t> MovingFrames(const std::vector<Frame>& frames, const Segment& segment, double min_px) {
  std::vector<std::size_t> moving = {0};
  for (std::size_t i = 1; i < segment.frames.size(); ++i) {
    const auto pairs = Match(frames[segment.frames[moving.back()]], frames[segment.frames[i]]);
    if (pairs.empty() || MedianDisparity(pairs) >= min_px) moving.push_back(i);
  }
  return moving;
}

std::vector<std::size_t> EveryNth(const std::vector<std::size_t>& places, std::size_t n) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < places.size(); i += n) kept.push_back(places[i]);
  if (kept.back() != places.back()) kept.push_back(places.back());
  return kept;
}

struct Sighting {
  int frame;  // of the problem
  const Feature* feature;
};

/// Where a track starts: triangulated with some of its sightings, far away if that fails.
BundlePoint InitialPoint(const std::vector<Sighting>& sightings, const std::vector<geometry::SE3>& poses, double far) {
  std::vector<geometry::View> views;
  const std::size_t used = std::min(sightings.size(), kTriangulationViews);
  for (std::size_t k = 0; k < used; ++k) {
    const Sighting& sighting = sightings[k * (sightings.size() - 1) / (used - 1)];
    views.push_back({poses[sighting.frame], sighting.feature->x});
  }
  const geometry::SE3& anchor = poses[sightings.front().frame];
  const Eigen::Vector2d& x = sightings.front().feature->x;
  const auto point = geometry::TriangulateViews(views);
  const double z = point ? (anchor * point->position_world).z() : 0.0;
  return {sightings.front().frame, {x.x(), x.y(), z > 0.0 ? 1.0 / z : far}};
}

/// `places` are the segment's frames that take part. A track is cut every `span` of them into points of their own, each
/// track at other frames, so that no frame loses its ties to its neighbours.
RunBundle BuildProblem(const std::vector<Frame>& frames, const Segment& segment, const std::vector<std::size_t>& places,
                       int span, double far) {
  RunBundle problem;
  problem.frames = places;
  std::unordered_map<std::int64_t, std::size_t> numbers;
  std::vector<std::pair<std::int64_t, std::vector<Sighting>>> tracks;
  for (std::size_t k = 0; k < places.size(); ++k) {
    problem.bundle.T_cam_world.push_back(segment.T_cam_world[places[k]]);
    const Frame& seen = frames[segment.frames[places[k]]];
    const bool crowded = seen.features.size() >= kCrowd;
    for (const Feature& feature : seen.features) {
      const auto [place, is_new] = numbers.try_emplace(feature.track, tracks.size());
      const int frame = static_cast<int>(k);
      const int shift = static_cast<int>(span * std::fmod(kGoldenSection * static_cast<double>(feature.track), 1.0));
      const auto piece = [&](int f) { return (f + shift) / span; };
      if (is_new || (crowded && piece(frame) != piece(tracks[place->second].second.front().frame))) {
        place->second = tracks.size();
        tracks.emplace_back(feature.track, std::vector<Sighting>());
      }
      tracks[place->second].second.push_back({frame, &feature});
    }
  }
  for (const auto& [track, sightings] : tracks) {
    if (sightings.size() < kFewestSightings) continue;
    const int id = static_cast<int>(problem.tracks.size());
    problem.tracks.push_back(track);
    problem.bundle.points.push_back(InitialPoint(sightings, problem.bundle.T_cam_world, far));
    for (const auto& [frame, feature] : sightings) {
      problem.bundle.observations.push_back({frame, id, feature->x, feature->J_pixel_normalized});
    }
  }
  return problem;
}

int FarthestFrame(const BundleProblem& problem) {
  const geometry::SE3 T_world_first = problem.T_cam_world.front().Inverse();
  const auto farthest = std::ranges::max_element(problem.T_cam_world, {}, [&](const geometry::SE3& T_cam_world) {
    return (T_cam_world * T_world_first).translation().norm();
  });
  return static_cast<int>(farthest - problem.T_cam_world.begin());
}

}  // namespace

RunBundle BuildRunBundle(const FinalRefinementOptions& options, const std::vector<Frame>& frames,
                         const Segment& segment) {
  double mean_inverse_depth = 0.0;
  for (const Point& point : segment.points) {
    const double z = (segment.T_cam_world.front() * point.position).norm();
    mean_inverse_depth += 1.0 / std::max(z, 1e-9) / static_cast<double>(segment.points.size());
  }
  const auto moving = MovingFrames(frames, segment, options.min_disparity_px);
  for (std::size_t n = 1;; ++n) {
    for (const int span : kSpans) {
      RunBundle problem = BuildProblem(frames, segment, EveryNth(moving, n), span, kFarShare * mean_inverse_depth);
      problem.bundle.scale_frame = FarthestFrame(problem.bundle);
      const double cost = BlockSkyline::Cost(BundleSkyline(problem.bundle));
      if (cost <= options.max_block_products || problem.frames.size() <= 2) return problem;
    }
  }
}

}  // namespace evo::odometry
