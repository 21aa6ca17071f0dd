#pragma once

#include <Eigen/Core>
#include <span>

#include "evaluation/trajectory/association.hpp"
#include "evo/evaluation/alignment.hpp"

namespace evo::evaluation {

/// Fits `alignment` to the matched poses. `up` is a unit vector in the truth's world frame; only posyaw needs it.
/// Throws Error (kDegenerateAlignment) if the poses do not determine the alignment: positions on a line or a point, no
/// motion, or fewer than three poses for least squares.
Similarity FitAlignment(std::span<const PosePair> pairs, const Alignment& alignment, const Eigen::Vector3d& up);

}  // namespace evo::evaluation
