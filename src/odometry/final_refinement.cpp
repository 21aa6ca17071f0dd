#include "evo/odometry/final_refinement.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "evo/geometry/triangulation.hpp"
#include "evo/odometry/block_skyline.hpp"
#include "evo/odometry/bundle_adjuster.hpp"
#include "evo/odometry/pose_optimizer.hpp"

namespace evo {

namespace {

constexpr std::size_t kFewestSightings = 3;  // of a track that takes part
constexpr std::size_t kTriangulationViews = 8;
constexpr double kFarShare = 1e-3;          // inverse depth of a track without parallax, of the usual one
constexpr double kMedianToSigma = 0.8493;   // the norm of a 2-d unit Gaussian has the median 1.1774
constexpr double kCauchyEfficient = 2.385;  // 95 % efficiency under Gaussian noise
constexpr double kOutlierSigmas = 5.0;
constexpr double kSmallestSigmaPx = 0.05;
constexpr double kLargestCorrelation = 0.99;
constexpr double kSmallestInverseDepth = 1e-9;

/// A bundle problem with the names of its parts.
struct NamedProblem {
  BundleProblem bundle;
  std::vector<std::size_t> frames;   // of the problem, as places in the segment
  std::vector<std::int64_t> tracks;  // of the problem's points
};

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
BundlePoint InitialPoint(const std::vector<Sighting>& sightings, const std::vector<SE3>& poses, double far) {
  std::vector<View> views;
  const std::size_t used = std::min(sightings.size(), kTriangulationViews);
  for (std::size_t k = 0; k < used; ++k) {
    const Sighting& sighting = sightings[k * (sightings.size() - 1) / (used - 1)];
    views.push_back({poses[sighting.frame], sighting.feature->x});
  }
  const SE3& anchor = poses[sightings.front().frame];
  const Eigen::Vector2d& x = sightings.front().feature->x;
  const auto point = TriangulateViews(views);
  const double z = point ? (anchor * point->position_world).z() : 0.0;
  return {sightings.front().frame, {x.x(), x.y(), z > 0.0 ? 1.0 / z : far}};
}

/// `places` are the segment's frames that take part; a track is cut into points of its own every `span` of them.
NamedProblem BuildProblem(const std::vector<Frame>& frames, const Segment& segment,
                          const std::vector<std::size_t>& places, int span, double far) {
  NamedProblem problem;
  problem.frames = places;
  std::unordered_map<std::int64_t, std::size_t> numbers;
  std::vector<std::pair<std::int64_t, std::vector<Sighting>>> tracks;
  for (std::size_t k = 0; k < places.size(); ++k) {
    problem.bundle.T_cam_world.push_back(segment.T_cam_world[places[k]]);
    for (const Feature& feature : frames[segment.frames[places[k]]].features) {
      const auto [place, is_new] = numbers.try_emplace(feature.track, tracks.size());
      const int frame = static_cast<int>(k);
      if (is_new || frame - tracks[place->second].second.front().frame >= span) {
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
      problem.bundle.observations.push_back({frame, id, feature->x, feature->px_per_unit});
    }
  }
  return problem;
}

int FarthestFrame(const BundleProblem& problem) {
  const SE3 T_world_first = problem.T_cam_world.front().Inverse();
  const auto farthest = std::ranges::max_element(problem.T_cam_world, {}, [&](const SE3& T_cam_world) {
    return (T_cam_world * T_world_first).translation().norm();
  });
  return static_cast<int>(farthest - problem.T_cam_world.begin());
}

/// The problem over as many frames as the budget allows.
NamedProblem BuildAffordableProblem(const FinalRefinementOptions& options, const std::vector<Frame>& frames,
                                    const Segment& segment) {
  double mean_inverse_depth = 0.0;
  for (const Point& point : segment.points) {
    const double z = (segment.T_cam_world.front() * point.position).norm();
    mean_inverse_depth += 1.0 / std::max(z, 1e-9) / static_cast<double>(segment.points.size());
  }
  const auto moving = MovingFrames(frames, segment, options.min_disparity_px);
  for (std::size_t n = 1;; ++n) {
    for (const int span : {std::numeric_limits<int>::max(), 120, 80, 60, 40}) {
      NamedProblem problem = BuildProblem(frames, segment, EveryNth(moving, n), span, kFarShare * mean_inverse_depth);
      problem.bundle.scale_frame = FarthestFrame(problem.bundle);
      const double cost = BlockSkyline::Cost(BundleSkyline(problem.bundle));
      if (cost <= options.budget || problem.frames.size() <= 2) return problem;
    }
  }
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The noise of the sightings, measured robustly from their residuals.
struct Noise {
  double sigma_px = kSmallestSigmaPx;  ///< of a coordinate
  double correlation = 0.0;            ///< between a track's neighbouring sightings
};

Noise MeasureNoise(const BundleProblem& problem) {
  const auto errors = BundleErrors(problem);
  std::vector<double> norms, differences;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!errors[i].allFinite()) continue;
    norms.push_back(errors[i].norm());
    const bool linked = i > 0 && problem.observations[i - 1].point == problem.observations[i].point;
    if (linked && errors[i - 1].allFinite()) differences.push_back((errors[i] - errors[i - 1]).norm());
  }
  if (differences.empty()) return {};
  const double sigma = std::max(kSmallestSigmaPx, kMedianToSigma * Median(std::move(norms)));
  const double step = kMedianToSigma * Median(std::move(differences));
  return {sigma, std::clamp(1.0 - 0.5 * step * step / (sigma * sigma), 0.0, kLargestCorrelation)};
}

/// Leaves out the tracks that mostly contradict the motion: things that move by themselves, and slips.
void DropContradictions(double sigma_px, BundleProblem* problem) {
  const auto errors = BundleErrors(*problem);
  std::vector<int> balance(problem->points.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    balance[problem->observations[i].point] += errors[i].norm() < kOutlierSigmas * sigma_px ? 1 : -1;
  }
  std::erase_if(problem->observations, [&](const BundleObservation& o) { return balance[o.point] < 0; });
}

/// Rounds of adjustment, each with the noise that the one before has left.
Noise Adjust(const FinalRefinementOptions& options, const std::function<void(double)>& progress,
             BundleProblem* problem) {
  Noise noise = MeasureNoise(*problem);
  for (int round = 0; round < options.rounds; ++round) {
    const auto summary = AdjustBundle({.iterations = options.iterations,
                                       .loss_px = kCauchyEfficient * noise.sigma_px,
                                       .correlation = noise.correlation},
                                      problem);
    spdlog::debug(
        "odometry: {} frames, {} points, {} sightings, noise {:.2f} px, correlation {:.2f}: cost {:.1f} to "
        "{:.1f} in {} iterations",
        problem->T_cam_world.size(), problem->points.size(), problem->observations.size(), noise.sigma_px,
        noise.correlation, summary.initial_cost, summary.final_cost, summary.iterations);
    noise = MeasureNoise(*problem);
    DropContradictions(noise.sigma_px, problem);
    progress(0.9 * (round + 1) / options.rounds);
  }
  return noise;
}

/// The refined points that lie in front, with their histories; kept apart by track for the frames' poses.
std::unordered_map<std::int64_t, Eigen::Vector3d> TakePoints(const NamedProblem& problem, double sigma,
                                                             Segment* segment) {
  std::vector<Point> points(problem.tracks.size());
  const auto errors = BundleErrors(problem.bundle);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    Point& point = points[problem.bundle.observations[i].point];
    ++(errors[i].norm() < kOutlierSigmas * sigma ? point.inliers : point.outliers);
  }
  std::unordered_map<std::int64_t, Eigen::Vector3d> positions;
  segment->points.clear();
  for (std::size_t p = 0; p < points.size(); ++p) {
    const BundlePoint& refined = problem.bundle.points[p];
    if (points[p].inliers < static_cast<int>(kFewestSightings)) continue;
    if (!(refined.inverse_depth.z() > kSmallestInverseDepth)) continue;
    points[p].track = problem.tracks[p];
    points[p].position = WorldPosition(problem.bundle, refined);
    positions[points[p].track] = points[p].position;
    segment->points.push_back(points[p]);
  }
  return positions;
}

PoseEstimate EstimatePose(const Frame& frame, const std::unordered_map<std::int64_t, Eigen::Vector3d>& positions,
                          const SE3& start, const PoseOptimizer& optimizer) {
  std::vector<PoseObservation> observations;
  for (const Feature& feature : frame.features) {
    const auto found = positions.find(feature.track);
    if (found != positions.end()) observations.push_back({found->second, feature.x, feature.px_per_unit});
  }
  return optimizer.Optimize(observations, start);
}

}  // namespace

void Register(Parameters& parameters, FinalRefinementOptions& options) {
  parameters.Add("odometry.final_refinement", &options.enabled, "bundle-adjust the whole run at the end");
  parameters.Add("odometry.final.min_disparity_px", &options.min_disparity_px, 0, 100,
                 "image motion in px between the frames that take part");
  parameters.Add("odometry.final.iterations", &options.iterations, 1, 1000, "iterations of each round");
  parameters.Add("odometry.final.rounds", &options.rounds, 1, 100, "rounds, the noise measured anew before each");
  parameters.Add("odometry.final.budget", &options.budget, 1e3, 1e12,
                 "block products an iteration may cost before frames are thinned out");
}

void RefineSegment(const FinalRefinementOptions& options, const std::vector<Frame>& frames, int before, int after,
                   const std::function<void(double)>& progress, Segment* segment) {
  NamedProblem problem = BuildAffordableProblem(options, frames, *segment);
  const Noise noise = Adjust(options, progress, &problem.bundle);
  const auto positions = TakePoints(problem, noise.sigma_px, segment);

  const PoseOptimizer optimizer({});
  Segment refined;
  refined.points = std::move(segment->points);
  const auto estimate = [&](int frame, const SE3& start) -> bool {
    const PoseEstimate pose = EstimatePose(frames[frame], positions, start, optimizer);
    if (!optimizer.Accepts(pose)) return false;
    refined.frames.push_back(frame);
    refined.T_cam_world.push_back(pose.T_cam_world);
    refined.inliers.push_back(pose.inlier_count);
    return true;
  };
  SE3 start = problem.bundle.T_cam_world.front();
  for (int frame = segment->frames.front() - 1; frame >= before && estimate(frame, start); --frame) {
    start = refined.T_cam_world.back();
  }
  std::ranges::reverse(refined.frames);
  std::ranges::reverse(refined.T_cam_world);
  std::ranges::reverse(refined.inliers);
  std::size_t next = 0;
  for (std::size_t i = 0; i < segment->frames.size(); ++i) {
    const bool adjusted = next < problem.frames.size() && problem.frames[next] == i;
    if (adjusted) start = problem.bundle.T_cam_world[next++];
    if (!adjusted) {
      if (estimate(segment->frames[i], start)) start = refined.T_cam_world.back();
      continue;
    }
    refined.frames.push_back(segment->frames[i]);
    refined.T_cam_world.push_back(start);
    refined.inliers.push_back(EstimatePose(frames[segment->frames[i]], positions, start, optimizer).inlier_count);
  }
  for (int frame = segment->frames.back() + 1; frame < after && estimate(frame, start); ++frame) {
    start = refined.T_cam_world.back();
  }
  *segment = std::move(refined);
  progress(1.0);
}

}  // namespace evo
