#include "odometry/frontend/bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "evo/core/median.hpp"
#include "evo/geometry/triangulation.hpp"
#include "evo/geometry/two_view.hpp"
#include "odometry/bundle/bundle_adjuster.hpp"
#include "odometry/bundle/reprojection.hpp"
#include "odometry/frontend/pose_optimizer.hpp"

namespace evo::odometry {

namespace {

constexpr double kHoldPx = 1.0;      // image motion after which a frame is held as another first frame
constexpr double kTryAgainPx = 1.5;  // image motion between two tries
constexpr int kRefinedFrames = 12;   // of those between the pair
constexpr double kGoodPx = 2.0;      // residual after refinement
constexpr double kGoodShare = 0.75;  // of all residuals

std::string Decimal(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

double Parallax(const Feature& first, const Feature& second, const geometry::SE3& T_2_1) {
  const Eigen::Vector3d a = T_2_1.rotation() * first.x.homogeneous();
  const Eigen::Vector3d b = second.x.homogeneous();
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

Bootstrapper::Bootstrapper(const BootstrapOptions& options, const std::vector<Frame>& frames, double focal_px)
    : options_(options), frames_(frames), focal_px_(focal_px) {
  Reset();
}

void Bootstrapper::Reset() {
  held_.clear();
  next_try_px_ = options_.min_disparity_px;
  obstacle_ = "no frames";
}

bool Bootstrapper::Refuse(const std::string& why) {
  obstacle_ = why;
  return false;
}

std::optional<Bootstrap> Bootstrapper::Add(int index) {
  const Frame& frame = frames_[index];
  const auto give_up_oldest = [&] {
    held_.pop_front();
    next_try_px_ = options_.min_disparity_px;
  };
  std::optional<Bootstrap> bootstrap;
  while (!held_.empty() && !bootstrap) {
    const auto pairs = Match(frames_[held_.front()], frame);
    // The few tracks that are there when a car sets off know its first steps badly.
    const int needed = std::max(
        options_.min_inliers, static_cast<int>(options_.min_shared_ratio * static_cast<double>(frame.features.size())));
    if (static_cast<int>(pairs.size()) < needed) {
      Refuse("only " + std::to_string(pairs.size()) + " tracks of " + std::to_string(frame.features.size()) +
             " live long enough; " + std::to_string(needed) + " are needed");
      give_up_oldest();
      continue;
    }
    const double disparity = MedianDisparity(pairs);
    if (disparity < next_try_px_) {
      if (disparity < options_.min_disparity_px) {
        Refuse("too little motion: the image moved " + Decimal(disparity) + " px, " +
               Decimal(options_.min_disparity_px) + " px are needed");
      }
      break;
    }
    bootstrap = Try(held_.front(), index);
    next_try_px_ = disparity + kTryAgainPx;
    if (bootstrap || disparity < options_.max_disparity_px) break;
    give_up_oldest();
  }
  if (held_.empty() || MedianDisparity(Match(frames_[held_.back()], frame)) > kHoldPx) held_.push_back(index);
  return bootstrap;
}

std::optional<Bootstrap> Bootstrapper::Try(int first, int last) {
  const auto pairs = Match(frames_[first], frames_[last]);
  std::vector<geometry::Correspondence> correspondences;
  correspondences.reserve(pairs.size());
  for (const auto& [a, b] : pairs) correspondences.push_back({a->x, b->x});
  const auto motion = geometry::EstimateRelativePose(correspondences, {.threshold = options_.inlier_px / focal_px_});
  const int inliers = motion ? motion->inlier_count : 0;
  if (inliers < options_.min_inliers || inliers < options_.min_inlier_ratio * static_cast<double>(pairs.size())) {
    Refuse("no rigid motion: " + std::to_string(inliers) + " of " + std::to_string(pairs.size()) +
           " tracks agree with the best one");
    return std::nullopt;
  }
  std::vector<double> parallaxes;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (motion->inliers[i]) parallaxes.push_back(Parallax(*pairs[i].first, *pairs[i].second, motion->T_2_1));
  }
  if (!HasParallax(parallaxes)) return std::nullopt;
  auto bootstrap = FromMotion(first, last, pairs, motion->T_2_1, motion->inliers);
  if (!bootstrap) return std::nullopt;
  // Once more: two views of a turn also fit a slightly other turn and a move past things at one distance. All frames
  // together do not.
  parallaxes.clear();
  for (const Point& point : bootstrap->points) {
    const Feature& begin = *frames_[first].Find(point.track);
    const Feature& end = *frames_[last].Find(point.track);
    parallaxes.push_back(Parallax(begin, end, bootstrap->T_cam_world.back()));
  }
  return HasParallax(parallaxes) ? bootstrap : std::nullopt;
}

bool Bootstrapper::HasParallax(const std::vector<double>& parallaxes) {
  const double degrees = Median(parallaxes) * 180.0 / std::numbers::pi;
  return degrees >= options_.min_parallax_deg ||
         Refuse("too little parallax (" + Decimal(degrees) + " degrees): the camera only turned");
}

std::optional<Bootstrap> Bootstrapper::FromMotion(int first, int last, const std::vector<FeaturePair>& pairs,
                                                  const geometry::SE3& T_2_1, const std::vector<bool>& inliers) {
  Bootstrap bootstrap{first, last, std::vector<geometry::SE3>(static_cast<std::size_t>(last - first + 1)), {}};
  std::vector<double> depths;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!inliers[i]) continue;
    const auto depth = geometry::TriangulatePair(pairs[i].first->x, pairs[i].second->x, T_2_1);
    if (!depth || !(depth->z1 > 0.0)) continue;
    bootstrap.points.push_back({pairs[i].first->track, depth->z1 * pairs[i].first->x.homogeneous(), 1, 0});
    depths.push_back(depth->z1);
  }
  if (static_cast<int>(depths.size()) < options_.min_inliers) return std::nullopt;
  const double scale = options_.median_depth / Median(depths);
  for (Point& point : bootstrap.points) point.position *= scale;
  bootstrap.T_cam_world.back() = geometry::SE3(T_2_1.rotation(), scale * T_2_1.translation());
  const bool agrees =
      TrackBetween(&bootstrap) && (!options_.refine || (Refine(&bootstrap) && TrackBetween(&bootstrap)));
  if (!agrees) {
    Refuse("the frames between do not agree with the pair's motion");
    return std::nullopt;
  }
  return bootstrap;
}

/// Poses of the frames between the pair against the points.
bool Bootstrapper::TrackBetween(Bootstrap* bootstrap) const {
  const PoseOptimizer optimizer({});
  for (std::size_t i = 1; i < bootstrap->T_cam_world.size(); ++i) {
    std::vector<PoseObservation> observations;
    const Frame& frame = frames_[static_cast<std::size_t>(bootstrap->first) + i];
    for (const Point& point : bootstrap->points) {
      const Feature* const feature = frame.Find(point.track);
      if (feature) observations.push_back({point.position, feature->x, feature->J_pixel_normalized});
    }
    const auto estimate = optimizer.Optimize(observations, bootstrap->T_cam_world[i - 1]);
    if (!optimizer.Accepts(estimate)) return false;
    bootstrap->T_cam_world[i] = estimate.T_cam_world;
  }
  return true;
}

/// Bundle adjustment over some of the frames; whether nearly all residuals are small afterwards.
bool Bootstrapper::Refine(Bootstrap* bootstrap) const {
  const int count = static_cast<int>(bootstrap->T_cam_world.size());
  const int used = std::min(count, kRefinedFrames);
  BundleProblem problem;
  std::vector<int> chosen;
  for (int k = 0; k < used; ++k) {
    chosen.push_back(k * (count - 1) / (used - 1));
    problem.T_cam_world.push_back(bootstrap->T_cam_world[chosen.back()]);
  }
  for (std::size_t p = 0; p < bootstrap->points.size(); ++p) {
    const Eigen::Vector3d& position = bootstrap->points[p].position;
    problem.points.push_back({0, Eigen::Vector3d(position.x(), position.y(), 1.0) / position.z()});
    for (int k = 0; k < used; ++k) {
      const Feature* const feature = frames_[bootstrap->first + chosen[k]].Find(bootstrap->points[p].track);
      if (feature) problem.observations.push_back({k, static_cast<int>(p), feature->x, feature->J_pixel_normalized});
    }
  }
  AdjustBundle({}, &problem);
  const auto errors = ReprojectionErrors(problem);
  const auto good = std::ranges::count_if(errors, [](const auto& error) { return error.norm() < kGoodPx; });
  if (static_cast<double>(good) < kGoodShare * static_cast<double>(errors.size())) return false;
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
  for (int k = 0; k < used; ++k) {
    const geometry::SE3& pose = problem.T_cam_world[k];
    bootstrap->T_cam_world[chosen[k]] = geometry::SE3(pose.rotation(), scale * pose.translation());
  }
  return true;
}

}  // namespace evo::odometry
