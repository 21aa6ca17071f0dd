#pragma once

#include <string>

namespace evo {
class Parameters;
}

namespace evo::evaluation {

/// See Associate. `association` is also "index" for files without stamps, which no parameter selects.
struct AssociationOptions {
  std::string association = "interpolate";
  double max_difference_s = -1.0;
  double max_interpolation_s = 0.5;
  double estimate_clock_offset_s = 0.0;
};

/// See SelectPairs.
struct RelativePoseErrorOptions {
  std::string deltas = "1f,1s,10m";
  std::string pairs = "consecutive";
  double tolerance = 0.1;
  std::string pairs_from = "estimate";
  bool required = false;  ///< a delta without pairs is an Error (kNothingToDo)
};

/// See EvaluateSegments.
struct SegmentOptions {
  std::string kitti_lengths_m = "100,200,300,400,500,600,700,800";
  int kitti_step = 10;
  std::string subtrajectory_lengths = "10%,20%,30%,40%,50%";
  double scale_segment_m = 10.0;
};

struct EvaluationOptions {
  AssociationOptions association;
  RelativePoseErrorOptions rpe;
  SegmentOptions segments;
  std::string project = "none";
  std::string up = "auto";
  std::string forward = "travel";
  double chord_m = 1.0;
  double gap_s = 0.5;
  bool skip_degenerate_alignments = false;  ///< instead of an Error (kDegenerateAlignment)
};

void Register(Parameters& parameters, EvaluationOptions& options);

struct TrackTruthOptions {
  double depth_edge_ratio = 0.1;
  double surface_radius_px = 3.0;
};

void Register(Parameters& parameters, TrackTruthOptions& options);

}  // namespace evo::evaluation
