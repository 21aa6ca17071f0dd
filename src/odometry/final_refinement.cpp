#include "evo/odometry/final_refinement.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
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
  return {anchor.Inverse(), {x.x(), x.y(), z > 0.0 ? 1.0 / z : far}};
}

NamedProblem BuildProblem(const std::vector<Frame>& frames, const Segment& segment,
                          const std::vector<std::size_t>& places, double far) {
  NamedProblem problem;
  problem.frames = places;
  std::unordered_map<std::int64_t, std::size_t> numbers;
  std::vector<std::pair<std::int64_t, std::vector<Sighting>>> tracks;
  for (std::size_t k = 0; k < places.size(); ++k) {
    problem.bundle.T_cam_world.push_back(segment.T_cam_world[places[k]]);
    for (const Feature& feature : frames[segment.frames[places[k]]].features) {
      const auto [place, is_new] = numbers.try_emplace(feature.track, tracks.size());
      if (is_new) tracks.emplace_back(feature.track, std::vector<Sighting>());
      tracks[place->second].second.push_back({static_cast<int>(k), &feature});
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
    NamedProblem problem = BuildProblem(frames, segment, EveryNth(moving, n), kFarShare * mean_inverse_depth);
    const double cost = BlockSkyline::Cost(BundleSkyline(problem.bundle));
    if (cost <= options.budget || problem.frames.size() <= 2) return problem;
  }
}

double RobustSigma(std::vector<double> residuals) {
  if (residuals.empty()) return kSmallestSigmaPx;
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return std::max(kSmallestSigmaPx, kMedianToSigma * *middle);
}

double PathLength(const std::vector<SE3>& poses) {
  double length = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    length += (poses[i].Inverse().translation() - poses[i - 1].Inverse().translation()).norm();
  }
  return length;
}

/// The scale is free in the adjustment: gives the path its length back, about the first camera.
void RestoreScale(double path, BundleProblem* problem) {
  const double scale = path / std::max(PathLength(problem->T_cam_world), 1e-12);
  const SE3 T_first_world = problem->T_cam_world.front();
  const SE3 T_world_first = T_first_world.Inverse();
  const auto rescale = [&](const SE3& T_cam_world) {
    const SE3 T_cam_first = T_cam_world * T_world_first;
    return SE3(T_cam_first.rotation(), scale * T_cam_first.translation()) * T_first_world;
  };
  for (SE3& pose : problem->T_cam_world) pose = rescale(pose);
  for (BundlePoint& point : problem->points) {
    point.T_world_anchor = rescale(point.T_world_anchor.Inverse()).Inverse();
    point.inverse_depth.z() /= scale;
  }
}

/// Two rounds: a fixed loss to find the noise, then the loss that suits it without the gross outliers.
double Adjust(const FinalRefinementOptions& options, const std::function<void(double)>& progress,
              BundleProblem* problem) {
  const double path = PathLength(problem->T_cam_world);
  const auto first = AdjustBundle({.iterations = options.iterations, .loss_px = options.loss_px}, problem);
  progress(0.5);
  const auto residuals = BundleResiduals(*problem);
  const double sigma = RobustSigma(residuals);
  std::vector<BundleObservation> kept;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (residuals[i] < kOutlierSigmas * sigma) kept.push_back(problem->observations[i]);
  }
  problem->observations = std::move(kept);
  const auto second = AdjustBundle({.iterations = options.iterations, .loss_px = kCauchyEfficient * sigma}, problem);
  RestoreScale(path, problem);
  spdlog::debug("odometry: refined {} frames, {} points, {} sightings in {} + {} iterations; noise {:.2f} px",
                problem->T_cam_world.size(), problem->points.size(), problem->observations.size(), first.iterations,
                second.iterations, sigma);
  progress(0.9);
  return sigma;
}

/// The refined points that lie in front, with their histories; kept apart by track for the frames' poses.
std::unordered_map<std::int64_t, Eigen::Vector3d> TakePoints(const NamedProblem& problem, double sigma,
                                                             Segment* segment) {
  std::vector<Point> points(problem.tracks.size());
  const auto residuals = BundleResiduals(problem.bundle);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    Point& point = points[problem.bundle.observations[i].point];
    ++(residuals[i] < kOutlierSigmas * sigma ? point.inliers : point.outliers);
  }
  std::unordered_map<std::int64_t, Eigen::Vector3d> positions;
  segment->points.clear();
  for (std::size_t p = 0; p < points.size(); ++p) {
    const BundlePoint& refined = problem.bundle.points[p];
    if (points[p].inliers < static_cast<int>(kFewestSightings)) continue;
    if (!(refined.inverse_depth.z() > kSmallestInverseDepth)) continue;
    points[p].track = problem.tracks[p];
    points[p].position = refined.World();
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
  parameters.Add("odometry.final.iterations", &options.iterations, 1, 1000, "iterations of each of the two rounds");
  parameters.Add("odometry.final.loss_px", &options.loss_px, 0.05, 20, "width of the robust loss in the first round");
  parameters.Add("odometry.final.budget", &options.budget, 1e3, 1e12,
                 "block products an iteration may cost before frames are thinned out");
}

void RefineSegment(const FinalRefinementOptions& options, const std::vector<Frame>& frames, int before, int after,
                   const std::function<void(double)>& progress, Segment* segment) {
  NamedProblem problem = BuildAffordableProblem(options, frames, *segment);
  const double sigma = Adjust(options, progress, &problem.bundle);
  const auto positions = TakePoints(problem, sigma, segment);

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
