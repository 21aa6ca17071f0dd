#include "evo/evaluation/evaluation_options.hpp"

#include "evaluation/trajectory/matched_trajectory.hpp"
#include "evo/core/error.hpp"
#include "evo/core/parameters.hpp"
#include "evo/evaluation/delta.hpp"

namespace evo::evaluation {

namespace {

bool AreDeltas(const std::string& text) {
  try {
    ParseDeltas(text);
    return true;
  } catch (const Error&) {
    return false;
  }
}

bool AreLengths(const std::string& text) {
  try {
    ParseLengths(text, 1.0);
    return true;
  } catch (const Error&) {
    return false;
  }
}

void Register(Parameters& parameters, AssociationOptions& options) {
  parameters.Add("evaluation.association", &options.association, {"interpolate", "nearest", "unique", "nearest-truth"},
                 "rule that matches an estimated pose with a true one");
  parameters.Add("evaluation.max_interpolation_s", &options.max_interpolation_s, 0.0, 1e3,
                 "interpolate: maximum time between true poses to interpolate (s)");
  parameters.Add("evaluation.max_difference_s", &options.max_difference_s, -1.0, 1e3,
                 "other rules: maximum time between matched poses (s); negative: 0.01 for nearest, 0.02 for unique, "
                 "twice the median interval of the truth for nearest-truth");
  parameters.Add("evaluation.estimate_clock_offset_s", &options.estimate_clock_offset_s, -1e9, 1e9,
                 "offset added to the estimate's stamps (s)");
}

void Register(Parameters& parameters, RelativePoseErrorOptions& options) {
  parameters.Add("evaluation.rpe_deltas", &options.deltas, AreDeltas, "a list such as 1f,0.5s,10m,5deg,0.1rad",
                 "distances between the poses of relative errors (frames, s, m, deg or rad)");
  parameters.Add("evaluation.rpe_pairs", &options.pairs, {"consecutive", "all", "closest"},
                 "rule that selects the pairs of poses");
  parameters.Add("evaluation.rpe_tolerance", &options.tolerance, 0.0, 1.0,
                 "maximum deviation of a pair from its distance (ratio)");
  parameters.Add("evaluation.rpe_pairs_from", &options.pairs_from, {"estimate", "truth"},
                 "trajectory along which the distance is measured");
}

void Register(Parameters& parameters, SegmentOptions& options) {
  const std::string expected = "a list of metres or percent of the path such as 100,50m,10%";
  parameters.Add("evaluation.kitti_lengths_m", &options.kitti_lengths_m, AreLengths, expected,
                 "lengths of the KITTI segments (m or % of the path)");
  parameters.Add("evaluation.kitti_step", &options.kitti_step, 1, 1'000'000,
                 "poses between the starts of KITTI segments");
  parameters.Add("evaluation.subtrajectory_lengths", &options.subtrajectory_lengths, AreLengths, expected,
                 "lengths of the sub-trajectories (m or % of the path)");
  parameters.Add("evaluation.scale_segment_m", &options.scale_segment_m, 1e-3, 1e6,
                 "path length that a local scale is computed from, at most a fifth of the path (m)");
  parameters.Alias("evaluation.scale_stretch_m", "evaluation.scale_segment_m");
}

}  // namespace

void Register(Parameters& parameters, EvaluationOptions& options) {
  Register(parameters, options.association);
  parameters.Add("evaluation.project", &options.project, {"none", "xy", "xz", "yz"},
                 "plane of the truth's world frame onto which poses are projected");
  parameters.Add("evaluation.up", &options.up, {"auto", "x", "y", "z", "-x", "-y", "-z"},
                 "axis of the truth's world frame that points up; auto: the axis nearest to the camera's mean up");
  parameters.Add("evaluation.forward", &options.forward, {"travel", "body"},
                 "longitudinal direction: the direction of travel or the true camera's optical axis");
  parameters.Add("evaluation.chord_m", &options.chord_m, 1e-3, 1e3,
                 "length of the chord of the true path that gives the direction of travel (m)");
  parameters.Add("evaluation.gap_s", &options.gap_s, 1e-3, 1e3,
                 "maximum time without an estimated pose that is not a gap (s)");
  Register(parameters, options.rpe);
  Register(parameters, options.segments);
}

void Register(Parameters& parameters, TrackTruthOptions& options) {
  parameters.Add("evaluation.depth_edge_ratio", &options.depth_edge_ratio, 0.001, 1,
                 "maximum relative difference between neighbouring depths of one surface (ratio)");
  parameters.Alias("evaluation.depth_edge", "evaluation.depth_edge_ratio");
  parameters.Add("evaluation.surface_radius_px", &options.surface_radius_px, 0.0, 20.0,
                 "radius around a track's start in which it may lie on any surface (px)");
  parameters.Alias("evaluation.surface_reach_px", "evaluation.surface_radius_px");
}

}  // namespace evo::evaluation
