#include "odometry/bundle/final_refinement.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "evo/core/median.hpp"
#include "odometry/bundle/bundle_adjuster.hpp"
#include "odometry/bundle/run_bundle.hpp"
#include "odometry/bundle/track_weights.hpp"
#include "odometry/frontend/pose_optimizer.hpp"
#include "odometry/uncertainty/pose_uncertainty.hpp"

namespace evo::odometry {

namespace {

constexpr int kFewestSightings = 3;         // of a point worth keeping
constexpr double kCauchyEfficient = 2.385;  // 95 % efficiency under Gaussian noise
constexpr double kUncertain = 3.0;          // times the usual standard deviation
constexpr double kSmallestInverseDepth = 1e-9;
// Share of the points that must agree in a frame between two of the bundle: at a stop most may be on others' cars.
constexpr double kFewestBetween = 0.35;

/// Leaves out the tracks that mostly contradict the motion: things that move by themselves, and slips.
void DropContradictions(BundleProblem* problem) {
  const auto errors = BundleErrors(*problem);
  const double sigma_px = MeasureNoise(errors);
  std::vector<int> balance(problem->points.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    balance[problem->observations[i].point] += errors[i].norm() < kOutlierSigmas * sigma_px ? 1 : -1;
  }
  std::erase_if(problem->observations, [&](const BundleObservation& o) { return balance[o.point] < 0; });
}

/// Rounds of adjustment, each with the noise that the one before has left; returns the last round's options.
BundleOptions Adjust(const FinalRefinementOptions& options, const std::function<void(double)>& progress,
                     const std::vector<double>& t, ThreadPool* pool, BundleProblem* problem) {
  BundleOptions last{.iterations = options.iterations, .drift = options.drift_variance_ratio};
  for (int round = 0; round < options.rounds; ++round) {
    if (options.track_noise && round > 0) WeighTracks(options.drift_variance_ratio, problem);
    const double sigma_px = MeasureNoise(BundleInnovations(*problem, options.drift_variance_ratio));
    if (options.velocity_change_scale > 0.0)
      problem->motion = MeasureMotion(problem->T_cam_world, t, options.velocity_change_scale, sigma_px);
    last.loss_px = kCauchyEfficient * sigma_px;
    const auto summary = AdjustBundle(last, problem, pool);
    spdlog::debug(
        "odometry: {} frames, {} points, {} sightings, noise {:.2f} px: cost {:.1f} to {:.1f} in {} iterations",
        problem->T_cam_world.size(), problem->points.size(), problem->observations.size(), sigma_px,
        summary.initial_cost, summary.final_cost, summary.iterations);
    DropContradictions(problem);
    progress(0.9 * (round + 1) / options.rounds);
  }
  return last;
}

/// The refined points of every track in order of time: a track may have been cut into several.
class RefinedPoints {
 public:
  /// `drifts` by frame of the run, in order, on the plane z = 1.
  void Add(std::int64_t track, const Eigen::Vector3d& position, std::vector<std::pair<int, Eigen::Vector2d>> drifts) {
    pieces_[track].push_back({position, std::move(drifts)});
  }

  PoseEstimate EstimatePose(const std::vector<Frame>& frames, int index, const geometry::SE3& start) const {
    std::vector<PoseObservation> observations;
    for (const Feature& feature : frames[index].features) {
      const auto found = pieces_.find(feature.track);
      if (found == pieces_.end()) continue;
      auto piece = std::ranges::upper_bound(found->second, index, {}, [](const Piece& p) { return p.drifts[0].first; });
      if (piece != found->second.begin()) --piece;
      observations.push_back({piece->position, feature.x - Drift(*piece, index), feature.J_pixel_normalized});
    }
    return optimizer_.Optimize(observations, start);
  }

  bool Accepts(const PoseEstimate& estimate, double min_inlier_ratio) const {
    return optimizer_.Accepts(estimate, min_inlier_ratio);
  }

 private:
  struct Piece {
    Eigen::Vector3d position;  // world
    std::vector<std::pair<int, Eigen::Vector2d>> drifts;
  };

  /// What the track has drifted by in that frame: about as much as in the frame of the bundle before it.
  static Eigen::Vector2d Drift(const Piece& piece, int index) {
    auto at = std::ranges::upper_bound(piece.drifts, index, {}, &std::pair<int, Eigen::Vector2d>::first);
    if (at != piece.drifts.begin()) --at;
    return at->second;
  }

  std::unordered_map<std::int64_t, std::vector<Piece>> pieces_;
  PoseOptimizer optimizer_{PoseOptions()};
};

/// Takes the points that lie in front, with their histories, into the segment's map.
RefinedPoints TakePoints(const RunBundle& run, double drift, Segment* segment) {
  std::vector<Point> points(run.tracks.size());
  std::vector<std::vector<std::pair<int, Eigen::Vector2d>>> histories(run.tracks.size());
  const auto errors = BundleErrors(run.bundle);
  const auto drifts = BundleDrifts(run.bundle, drift);
  const double sigma_px = MeasureNoise(errors);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const BundleObservation& observation = run.bundle.observations[i];
    Point& point = points[observation.point];
    ++(errors[i].norm() < kOutlierSigmas * sigma_px ? point.inliers : point.outliers);
    histories[observation.point].emplace_back(segment->frames[run.frames[observation.frame]],
                                              observation.J_pixel_normalized.inverse() * drifts[i]);
  }
  RefinedPoints refined;
  segment->points.clear();
  for (std::size_t p = 0; p < points.size(); ++p) {
    const BundlePoint& from = run.bundle.points[p];
    if (points[p].inliers < kFewestSightings || !(from.inverse_depth.z() > kSmallestInverseDepth)) continue;
    points[p].track = run.tracks[p];
    points[p].position = WorldPosition(run.bundle, from);
    refined.Add(points[p].track, points[p].position, std::move(histories[p]));
    segment->points.push_back(points[p]);
  }
  return refined;
}

/// The poses of all frames against the refined points. Those of the bundle stay as they are; the others, lost or not,
/// start from their neighbours, and the frames before and after the segment are taken in as far as they can be tracked.
class PoseFiller {
 public:
  /// Points err alike as tracks do: `alike` of them tell as much as one.
  PoseFiller(const std::vector<Frame>& frames, const RefinedPoints& points, double alike)
      : frames_(frames), points_(points), alike_(alike) {}

  /// From `frame` on in steps of `direction` up to but without `end`, while the poses can be estimated and are not far
  /// more uncertain than usual: the first pose, known by a few tracks just born, would turn the whole path.
  void Extend(int frame, int end, int direction, geometry::SE3 start) {
    const double usual = Median(turns_);
    for (; frame != end; frame += direction) {
      if (!Estimate(frame, start, PoseOptions().min_inlier_ratio)) return;
      if (turns_.back() > kUncertain * usual) {
        poses_.erase(frame);
        return;
      }
      start = poses_.at(frame).T_cam_world;
    }
  }

  /// `start` is the pose of a frame of the bundle nearby; false if less than a share of its points agree with any pose.
  bool Estimate(int frame, const geometry::SE3& start, double min_inlier_ratio) {
    const PoseEstimate estimate = points_.EstimatePose(frames_, frame, start);
    if (!points_.Accepts(estimate, min_inlier_ratio)) return false;
    // The points are as uncertain as the bundle's poses nearby.
    poses_[frame] = {estimate.T_cam_world, estimate.inlier_count, alike_ * estimate.covariance, false};
    turns_.push_back(Turn(estimate));
    return true;
  }

  void Keep(int frame, const geometry::SE3& T_cam_world) {
    const PoseEstimate estimate = points_.EstimatePose(frames_, frame, T_cam_world);
    poses_[frame] = {T_cam_world, estimate.inlier_count, geometry::Matrix6d::Zero(), true};
    if (estimate.inlier_count > 0) turns_.push_back(Turn(estimate));
  }

  void MoveTo(Segment* segment) const {
    segment->frames.clear();
    segment->T_cam_world.clear();
    segment->inliers.clear();
    segment->adjusted.clear();
    segment->besides.clear();
    for (const auto& [frame, pose] : poses_) {
      if (pose.is_adjusted) segment->adjusted.push_back(segment->frames.size());
      segment->frames.push_back(frame);
      segment->T_cam_world.push_back(pose.T_cam_world);
      segment->inliers.push_back(pose.inliers);
      segment->besides.push_back(pose.besides);
    }
  }

 private:
  struct Pose {
    geometry::SE3 T_cam_world;
    int inliers = 0;
    geometry::Matrix6d besides;
    bool is_adjusted = false;
  };

  /// How uncertain the camera's turn is if the points are known: standard deviation, rad.
  static double Turn(const PoseEstimate& estimate) {
    return std::sqrt(estimate.covariance.bottomRightCorner<3, 3>().trace());
  }

  const std::vector<Frame>& frames_;
  const RefinedPoints& points_;
  double alike_;
  std::map<int, Pose> poses_;
  std::vector<double> turns_;  // of all poses
};

}  // namespace

void RefineSegment(const FinalRefinementOptions& options, const std::vector<Frame>& frames, int before, int after,
                   const std::function<void(double)>& progress, ThreadPool* pool, Segment* segment) {
  RunBundle run = BuildRunBundle(options, frames, *segment);
  std::vector<double> t;
  for (const std::size_t place : run.frames) {
    t.push_back(ToSeconds(frames[segment->frames[place]].t - frames[segment->frames.front()].t));
  }
  const BundleOptions adjusted = Adjust(options, progress, t, pool, &run.bundle);
  segment->uncertainty = PoseUncertainty(options.covariance, adjusted, run.bundle, pool);
  const auto [first, end] = segment->uncertainty.CertainStretch();
  segment->uncertainty.Cut(first, end);
  const RefinedPoints points = TakePoints(run, options.drift_variance_ratio, segment);
  PoseFiller filler(frames, points, options.covariance.variance_inflation);
  const auto& poses = run.bundle.T_cam_world;
  const int end_frame = 1 + segment->frames[end == poses.size() ? segment->frames.size() - 1 : run.frames[end - 1]];
  for (std::size_t k = first; k < end; ++k) {
    const int frame = segment->frames[run.frames[k]];
    filler.Keep(frame, poses[k]);
    const int next = k + 1 < end ? segment->frames[run.frames[k + 1]] : end_frame;
    for (int between = frame + 1; between < next; ++between) {
      filler.Estimate(between, poses[k], kFewestBetween);
    }
  }
  if (first == 0) filler.Extend(segment->frames.front() - 1, before - 1, -1, poses.front());
  if (end == poses.size()) filler.Extend(segment->frames.back() + 1, after, 1, poses.back());
  filler.MoveTo(segment);
  progress(1.0);
}

}  // namespace evo::odometry
