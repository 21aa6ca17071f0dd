#pragma once

#include <vector>

#include "evo/odometry/odometry_options.hpp"
#include "evo/odometry/odometry_result.hpp"
#include "odometry/frontend/frame.hpp"
#include "odometry/segment.hpp"

namespace evo::odometry {

/// Removes the slow drift of the scale along the path, and its jump where the tracking was lost, by the height of the
/// camera above the ground that it drives over, which is constant; makes the run's unit the metre if the height is
/// given. The height is measured at each track's place along the path, where the camera passes the track: relative to
/// the path, not to the camera that observes the track, so that neither hills nor the camera's pitch matter. The camera
/// must be upright (rolled by less than about 20 degrees) and move parallel to the ground. Where no ground is seen, the
/// nearest scale holds. Nothing changes if there is no ground at all, if the height is not constant or, while it is not
/// given, if the path is shorter than ten heights; with a warning if it is given. Rotations never change. `frames` are
/// all frames of the run, `segments` its parts in order of time.
GroundScale ScaleByGround(const GroundOptions& options, const std::vector<Frame>& frames,
                          std::vector<Segment>* segments);

}  // namespace evo::odometry
