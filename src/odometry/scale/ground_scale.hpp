#pragma once

#include <vector>

#include "evo/odometry/odometry_options.hpp"
#include "evo/odometry/odometry_result.hpp"
#include "odometry/frontend/frame.hpp"
#include "odometry/segment.hpp"

namespace evo::odometry {

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
