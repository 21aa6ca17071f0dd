#pragma once

#include <string>

#include "evo/evaluation/evaluation.hpp"
#include "evo/report/gnuplot.hpp"
#include "evo/tracking/lifetime.hpp"

namespace evo {

// `name` is the one that the figure is drawn under, see Gnuplot::Draw. Colours are those of Okabe and Ito, which
// colour-blind readers tell apart; lines also differ in dash and width for black-and-white print.

/// Truth and aligned estimate seen from above, in m, equal axes, the start marked. The estimate is broken at gaps.
Figure TrajectoryFigure(const std::string& name, const Evaluation& evaluation, const AlignedEvaluation& result);

/// Longitudinal, lateral (signed) and planar error over time, in m and in % of the path.
Figure ErrorFigure(const std::string& name, const Evaluation& evaluation, const AlignedEvaluation& result);

/// Distribution of track lifetimes in frames with their mean.
Figure LifetimeFigure(const std::string& name, const LifetimeStatistics& statistics);

}  // namespace evo
