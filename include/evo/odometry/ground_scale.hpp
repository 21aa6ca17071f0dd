#pragma once

#include <cstddef>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/odometry/final_refinement.hpp"
#include "evo/odometry/frame.hpp"

namespace evo::odometry {

struct GroundOptions {
  bool hold_height = true;       ///< above a road, even if it is not known
  double camera_height_m = 0.0;  ///< of the camera above the road; 0: unknown, the scale stays arbitrary
  double drift = 0.002;          ///< standard deviation of the scale's change over a way of one height, relative
};
void Register(Parameters& parameters, GroundOptions& options);

/// What the ground has said about the scale.
struct GroundScale {
  bool found = false;      ///< else the scale is as arbitrary as before
  bool metric = false;     ///< the height was known
  std::size_t tracks = 0;  ///< on the ground
  double covered = 0.0;    ///< share of the path where the scale is known within a percent
  double error = 0.0;      ///< relative standard deviation of the scale, median over the path
  double lowest = 0.0;     ///< metres (or new units) to a unit of the map, least and
  double highest = 0.0;    ///< most along the path
};

/// Takes the slow drift of the scale along the path out, and the jump of the scale where the tracking was lost, by the
/// height of the camera above the ground that it has driven over, which is constant; turns the run's unit into metres
/// if it is known. The height is measured at each track's place along the path, where the camera came past the track:
/// from the path, not from the camera where it saw the track, so that neither hills nor the camera's pitch enter. Needs
/// a camera that is upright (rolled by less than about 20 degrees) and driven parallel to the ground. Where there is no
/// ground, the scale of the nearest holds; if there is none at all, if the height has changed or, while it is not
/// known, if the path is shorter than ten heights, everything stays as it is; with a warning if the height is known.
/// Rotations stay in any case. `frames` are all frames of the run; `segments` its parts in order of time.
GroundScale ScaleByGround(const GroundOptions& options, const std::vector<Frame>& frames,
                          std::vector<Segment>* segments);

}  // namespace evo::odometry
