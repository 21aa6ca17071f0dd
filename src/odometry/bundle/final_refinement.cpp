#include "odometry/bundle/final_refinement.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "evo/core/robust.hpp"
#include "odometry/bundle/bundle_adjuster.hpp"
#include "odometry/bundle/pose_completer.hpp"
#include "odometry/bundle/refined_points.hpp"
#include "odometry/bundle/reprojection.hpp"
#include "odometry/bundle/segment_bundle.hpp"
#include "odometry/bundle/track_weights.hpp"
#include "odometry/uncertainty/pose_uncertainty.hpp"

namespace evo::odometry {

namespace {

// Inlier ratio of a pose between two of the bundle: while the camera stands, the majority of points may be on other
// cars.
constexpr double kMinInlierRatioBetween = 0.35;
constexpr double kMinRelativeDecrease = 1e-3;  // of the cost in an iteration; less moves no pose noticeably
constexpr double kAdjustmentTime = 0.9;        // ratio of the whole refinement, for the progress

/// Removes the observations of tracks with more outliers than inliers: objects that move by themselves, and slips.
void RemoveOutlierTracks(BundleProblem* problem) {
  const auto errors = ReprojectionErrors(*problem);
  const double sigma_px = EstimateNoise(errors);
  std::vector<int> excess_inliers(problem->points.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    excess_inliers[problem->observations[i].point] += errors[i].norm() < kOutlierSigmas * sigma_px ? 1 : -1;
  }
  std::erase_if(problem->observations, [&](const BundleObservation& o) { return excess_inliers[o.point] < 0; });
}

/// Rounds of adjustment, each with the noise that the one before has left; returns the last round's options.
BundleOptions AdjustInRounds(const FinalRefinementOptions& options, const std::vector<double>& times_s,
                             const std::function<void(double)>& progress, ThreadPool* pool, BundleProblem* problem) {
  const double drift = options.drift_variance_ratio;
  BundleOptions bundle_options{.max_iterations = options.iterations,
                               .drift_variance_ratio = drift,
                               .min_relative_decrease = kMinRelativeDecrease};
  for (int round = 0; round < options.rounds; ++round) {
    if (options.track_noise && round > 0) SetTrackWeights(drift, problem);
    const double sigma_px = EstimateNoise(ReprojectionInnovations(*problem, drift));
    if (options.velocity_change_scale > 0.0) {
      problem->motion = EstimateMotionPrior(problem->T_cam_world, times_s, options.velocity_change_scale, sigma_px);
    }
    bundle_options.cauchy_width_px = kCauchyWidth * sigma_px;
    const BundleSummary summary = AdjustBundle(bundle_options, problem, pool);
    spdlog::debug(
        "odometry: {} frames, {} points, {} observations, noise {:.2f} px: cost {:.1f} to {:.1f} in {} iterations",
        problem->T_cam_world.size(), problem->points.size(), problem->observations.size(), sigma_px,
        summary.initial_cost, summary.final_cost, summary.iterations);
    RemoveOutlierTracks(problem);
    progress(kAdjustmentTime * (round + 1) / options.rounds);
  }
  return bundle_options;
}

/// Times of the bundle's poses since the segment's first, s.
std::vector<double> PoseTimes(const std::vector<Frame>& frames, const Segment& segment, const SegmentBundle& bundle) {
  std::vector<double> times_s;
  for (const std::size_t i : bundle.segment_poses) {
    times_s.push_back(ToSeconds(frames[segment.poses[i].frame].t - frames[segment.poses.front().frame].t));
  }
  return times_s;
}

/// The bundle's poses in `range` and those of all frames that can be tracked against the refined points.
PoseCompleter CompletePoses(const std::vector<Frame>& frames, const RefinedPoints& points, double variance_inflation,
                            const SegmentBundle& bundle, PoseRange range, const Segment& segment) {
  PoseCompleter completer(frames, points, variance_inflation);
  const auto& poses = bundle.problem.T_cam_world;
  const auto frame_of = [&](std::size_t pose) { return segment.poses[bundle.segment_poses[pose]].frame; };
  const int last_frame = range.end == poses.size() ? segment.poses.back().frame : frame_of(range.end - 1);
  for (std::size_t k = range.begin; k < range.end; ++k) {
    completer.AddAdjusted(frame_of(k), poses[k]);
    const int next_frame = k + 1 < range.end ? frame_of(k + 1) : last_frame + 1;
    for (int between = frame_of(k) + 1; between < next_frame; ++between) {
      completer.AddEstimated(between, poses[k], kMinInlierRatioBetween);
    }
  }
  return completer;
}

}  // namespace

void RefineSegment(const FinalRefinementOptions& options, const std::vector<Frame>& frames, int begin_frame,
                   int end_frame, const std::function<void(double)>& progress, ThreadPool* pool, Segment* segment) {
  SegmentBundle bundle = BuildSegmentBundle(options, frames, *segment);
  const auto& poses = bundle.problem.T_cam_world;
  const BundleOptions bundle_options =
      AdjustInRounds(options, PoseTimes(frames, *segment, bundle), progress, pool, &bundle.problem);
  auto uncertainty = EstimatePoseUncertainty(options.covariance, bundle_options, bundle.problem, pool);
  const PoseRange range = uncertainty ? uncertainty->certain_range : PoseRange{0, poses.size()};
  const RefinedPoints points(bundle, options.drift_variance_ratio, *segment);
  PoseCompleter completer =
      CompletePoses(frames, points, options.covariance.variance_inflation, bundle, range, *segment);
  const int first_frame = segment->poses[bundle.segment_poses[range.begin]].frame;
  completer.Extend(first_frame - 1, begin_frame - 1, -1, poses[range.begin]);
  if (range.end == poses.size()) completer.Extend(segment->poses.back().frame + 1, end_frame, 1, poses.back());
  segment->poses = completer.Poses();
  segment->points = points.points();
  segment->uncertainty = {};
  if (uncertainty) {
    uncertainty->errors.KeepRange(range);
    segment->uncertainty =
        SegmentUncertainty(std::move(uncertainty->errors), completer.AdjustedPoses(), completer.Covariances());
  }
  progress(1.0);
}

}  // namespace evo::odometry
