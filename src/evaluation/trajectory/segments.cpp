#include "evo/evaluation/segments.hpp"

#include "evo/core/error.hpp"

namespace evo::evaluation {

namespace {

bool AreLengths(const std::string& text) {
  try {
    ParseLengths(text, 1.0);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

void Register(Parameters& parameters, SegmentOptions& options) {
  const std::string expected = "a list of metres or shares of the path such as 100,50m,10%";
  parameters.Add("evaluation.kitti_lengths_m", &options.kitti_lengths_m, AreLengths, expected,
                 "lengths of the KITTI segments");
  parameters.Add("evaluation.kitti_step", &options.kitti_step, 1, 1'000'000,
                 "poses from the start of one KITTI segment to that of the next");
  parameters.Add("evaluation.subtrajectory_lengths", &options.subtrajectory_lengths, AreLengths, expected,
                 "lengths of the sub-trajectories");
  parameters.Add("evaluation.scale_stretch_m", &options.local_scale.stretch_m, 1e-3, 1e6,
                 "path that a local scale is taken from, at most a fifth of the whole (m)");
}

SegmentEvaluation EvaluateSegments(const MatchedPath& path, const Eigen::Vector3d& up, TimeNs from, TimeNs longest_gap,
                                   const SegmentOptions& options) {
  const double path_m = path.distance.back();
  return {ComputeKittiSegments(path, ParseLengths(options.kitti_lengths_m, path_m), options.kitti_step),
          ComputeSubTrajectoryErrors(path, ParseLengths(options.subtrajectory_lengths, path_m), up),
          ComputeLocalScale(path, from, longest_gap, options.local_scale)};
}

}  // namespace evo::evaluation
