#include "odometry/frontend/bootstrap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "evo/core/median.hpp"
#include "evo/geometry/triangulation.hpp"
#include "evo/geometry/two_view.hpp"
#include "odometry/bundle/bundle_adjuster.hpp"
#include "odometry/bundle/reprojection.hpp"
#include "odometry/frontend/pose_optimizer.hpp"

namespace evo::odometry {

namespace {

constexpr double kCandidateSpacingPx = 1.0;     // image motion between candidates; a closer one sees the same
constexpr double kRetryDisparityPx = 1.5;       // image motion between tries of a pair; a smaller one changes nothing
constexpr double kMinLastDisparityRatio = 0.3;  // of `min_disparity_px`, for the last pair of a candidate
constexpr std::size_t kMinLastPairs = 45;       // little motion of few tracks proves nothing
constexpr int kMaxRefinedFrames = 12;           // of the first map; more cost time and add little baseline
constexpr double kMaxResidualPx = 2.0;          // of a good observation after the refinement
constexpr double kMinGoodRatio = 0.75;          // of the observations; fewer: the motion is wrong

/// The angle between the rays from two cameras to one point, rad.
double Parallax(const Feature& first, const Feature& second, const geometry::SE3& T_2_1) {
  const Eigen::Vector3d a = T_2_1.rotation() * first.x.homogeneous();
  const Eigen::Vector3d b = second.x.homogeneous();
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Indices of the frames to adjust, evenly spaced from the first to the last.
std::vector<int> ChooseFrames(int count) {
  const int chosen_count = std::min(count, kMaxRefinedFrames);
  std::vector<int> chosen;
  for (int k = 0; k < chosen_count; ++k) chosen.push_back(k * (count - 1) / (chosen_count - 1));
  return chosen;
}

/// The bundle problem of a first map; its poses are those of the frames first + chosen[k].
BundleProblem BuildProblem(const Bootstrap& bootstrap, const std::vector<Frame>& frames,
                           const std::vector<int>& chosen) {
  BundleProblem problem;
  for (const int frame : chosen) problem.T_cam_world.push_back(bootstrap.T_cam_world[frame]);
  for (std::size_t p = 0; p < bootstrap.points.size(); ++p) {
    const Eigen::Vector3d& position = bootstrap.points[p].position;
    problem.points.push_back({0, Eigen::Vector3d(position.x(), position.y(), 1.0) / position.z()});
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const Feature* const feature = frames[bootstrap.first + chosen[k]].Find(bootstrap.points[p].track);
      if (!feature) continue;
      problem.observations.push_back(
          {static_cast<int>(k), static_cast<int>(p), feature->x, feature->J_pixel_normalized});
    }
  }
  return problem;
}

bool ResidualsAreSmall(const std::vector<Eigen::Vector2d>& errors) {
  const auto good = std::ranges::count_if(errors, [](const auto& error) { return error.norm() < kMaxResidualPx; });
  return static_cast<double>(good) >= kMinGoodRatio * static_cast<double>(errors.size());
}

}  // namespace

Bootstrapper::Bootstrapper(const BootstrapOptions& options, const std::vector<Frame>& frames, double focal_px)
    : options_(options), frames_(frames), focal_px_(focal_px) {
  Reset();
}

void Bootstrapper::Reset() {
  candidates_.clear();
  next_try_disparity_px_ = options_.min_disparity_px;
  failure_reason_ = "no frames";
}

bool Bootstrapper::Fail(std::string reason) {
  failure_reason_ = std::move(reason);
  return false;
}

void Bootstrapper::DropOldestCandidate() {
  candidates_.pop_front();
  next_try_disparity_px_ = options_.min_disparity_px;
}

std::optional<Bootstrap> Bootstrapper::Add(int index) {
  const Frame& frame = frames_[index];
  std::optional<Bootstrap> bootstrap;
  while (!candidates_.empty() && !bootstrap) {
    const auto pairs = Match(frames_[candidates_.front()], frame);
    // The few tracks of a car that has just set off determine its first motion badly.
    const int min_pairs = std::max(
        options_.min_inliers, static_cast<int>(options_.min_shared_ratio * static_cast<double>(frame.features.size())));
    if (static_cast<int>(pairs.size()) < min_pairs) {
      Fail(fmt::format("only {} tracks of {} live long enough; {} are needed", pairs.size(), frame.features.size(),
                       min_pairs));
      bootstrap = TryLastPair(candidates_.front(), index - 1);
      DropOldestCandidate();
      continue;
    }
    const double disparity_px = MedianDisparity(pairs);
    if (disparity_px < next_try_disparity_px_) {
      if (disparity_px < options_.min_disparity_px) {
        Fail(fmt::format("too little motion: the image moved {:.1f} px, {:.1f} px are needed", disparity_px,
                         options_.min_disparity_px));
      }
      break;
    }
    bootstrap = TryPair(candidates_.front(), index);
    next_try_disparity_px_ = disparity_px + kRetryDisparityPx;
    if (bootstrap || disparity_px < options_.max_disparity_px) break;
    DropOldestCandidate();
  }
  if (candidates_.empty() || MedianDisparity(Match(frames_[candidates_.back()], frame)) > kCandidateSpacingPx) {
    candidates_.push_back(index);
  }
  return bootstrap;
}

std::optional<Bootstrap> Bootstrapper::TryLastPair(int first, int last) {
  const auto pairs = Match(frames_[first], frames_[last]);
  if (pairs.size() < kMinLastPairs) return std::nullopt;
  if (MedianDisparity(pairs) < kMinLastDisparityRatio * options_.min_disparity_px) return std::nullopt;
  std::string reason = failure_reason_;
  auto bootstrap = TryPair(first, last);
  if (!bootstrap) failure_reason_ = std::move(reason);
  return bootstrap;
}

std::optional<Bootstrap> Bootstrapper::TryPair(int first, int last) {
  const auto pairs = Match(frames_[first], frames_[last]);
  std::vector<geometry::Correspondence> correspondences;
  correspondences.reserve(pairs.size());
  for (const auto& [a, b] : pairs) correspondences.push_back({a->x, b->x});
  const auto motion = geometry::EstimateRelativePose(
      correspondences, {.max_sampson_error = options_.inlier_px / focal_px_});  // equations 9-13
  const int inliers = motion ? motion->inlier_count : 0;
  if (inliers < options_.min_inliers || inliers < options_.min_inlier_ratio * static_cast<double>(pairs.size())) {
    Fail(fmt::format("no rigid motion: {} of {} tracks agree with the best one", inliers, pairs.size()));
    return std::nullopt;
  }
  std::vector<double> parallaxes;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (motion->inliers[i]) parallaxes.push_back(Parallax(*pairs[i].first, *pairs[i].second, motion->T_2_1));
  }
  if (!CheckParallax(parallaxes)) return std::nullopt;
  auto bootstrap = BuildMap(first, last, pairs, motion->T_2_1, motion->inliers);
  if (!bootstrap) return std::nullopt;
  // Two views of a rotation are also explained by a slightly different rotation and a translation past points at one
  // depth. All frames together are not, so the parallax is checked again with the refined motion.
  parallaxes.clear();
  for (const Point& point : bootstrap->points) {
    const Feature& begin = *frames_[first].Find(point.track);
    const Feature& end = *frames_[last].Find(point.track);
    parallaxes.push_back(Parallax(begin, end, bootstrap->T_cam_world.back()));
  }
  return CheckParallax(parallaxes) ? bootstrap : std::nullopt;
}

bool Bootstrapper::CheckParallax(const std::vector<double>& parallaxes) {
  const double degrees = Median(parallaxes) * 180.0 / std::numbers::pi;
  return degrees >= options_.min_parallax_deg ||
         Fail(fmt::format("too little parallax ({:.1f} degrees): the camera only rotated", degrees));
}

std::optional<Bootstrap> Bootstrapper::BuildMap(int first, int last, const std::vector<FeaturePair>& pairs,
                                                const geometry::SE3& T_2_1, const std::vector<bool>& inliers) {
  Bootstrap bootstrap{first, last, std::vector<geometry::SE3>(static_cast<std::size_t>(last - first + 1)), {}};
  std::vector<double> depths;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!inliers[i]) continue;
    const auto depth = geometry::TriangulatePair(pairs[i].first->x, pairs[i].second->x, T_2_1);  // equation 6
    if (!depth || !(depth->z1 > 0.0)) continue;
    bootstrap.points.push_back({pairs[i].first->track, depth->z1 * pairs[i].first->x.homogeneous(), 1, 0});
    depths.push_back(depth->z1);
  }
  if (static_cast<int>(depths.size()) < options_.min_inliers) return std::nullopt;
  const double scale = options_.median_depth / Median(depths);
  for (Point& point : bootstrap.points) point.position *= scale;
  bootstrap.T_cam_world.back() = geometry::SE3(T_2_1.rotation(), scale * T_2_1.translation());
  const bool consistent =
      TrackFrames(&bootstrap) && (!options_.refine || (RefineMap(&bootstrap) && TrackFrames(&bootstrap)));
  if (!consistent) {
    Fail("the frames between do not agree with the pair's motion");
    return std::nullopt;
  }
  return bootstrap;
}

bool Bootstrapper::TrackFrames(Bootstrap* bootstrap) const {
  const PoseOptimizer optimizer({});
  for (std::size_t i = 1; i < bootstrap->T_cam_world.size(); ++i) {
    std::vector<PoseObservation> observations;
    const Frame& frame = frames_[static_cast<std::size_t>(bootstrap->first) + i];
    for (const Point& point : bootstrap->points) {
      const Feature* const feature = frame.Find(point.track);
      if (feature) observations.push_back({point.position, feature->x, feature->J_pixel_normalized});
    }
    const auto estimate = optimizer.Optimize(observations, bootstrap->T_cam_world[i - 1]);  // equations 1-5
    if (!optimizer.Accepts(estimate)) return false;
    bootstrap->T_cam_world[i] = estimate.T_cam_world;
  }
  return true;
}

bool Bootstrapper::RefineMap(Bootstrap* bootstrap) const {
  const std::vector<int> chosen = ChooseFrames(static_cast<int>(bootstrap->T_cam_world.size()));
  BundleProblem problem = BuildProblem(*bootstrap, frames_, chosen);
  AdjustBundle({}, &problem);
  if (!ResidualsAreSmall(ReprojectionErrors(problem))) return false;
  std::vector<double> depths;
  for (const auto& point : problem.points) {
    if (point.inverse_depth.z() > 0.0) depths.push_back(1.0 / point.inverse_depth.z());
  }
  if (static_cast<int>(depths.size()) < options_.min_inliers) return false;
  const double scale = options_.median_depth / Median(depths);
  std::vector<Point> points;
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    if (!(problem.points[p].inverse_depth.z() > 0.0)) continue;
    points.push_back(bootstrap->points[p]);
    points.back().position = scale * WorldPosition(problem, problem.points[p]);
  }
  bootstrap->points = std::move(points);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const geometry::SE3& T_cam_world = problem.T_cam_world[k];
    bootstrap->T_cam_world[chosen[k]] = geometry::SE3(T_cam_world.rotation(), scale * T_cam_world.translation());
  }
  return true;
}

}  // namespace evo::odometry
