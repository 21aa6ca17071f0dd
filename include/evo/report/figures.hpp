#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "evo/evaluation/evaluation.hpp"
#include "evo/evaluation/lifetime.hpp"
#include "evo/report/gnuplot.hpp"

namespace evo::report {

// `name` is the one that the figure is drawn under, see Gnuplot::Draw. Colours are those of Okabe and Ito, which
// colour-blind readers tell apart; lines also differ in dash and width for black-and-white print. Curves are broken
// where poses are missing for longer than `evaluation.longest_gap`, and such gaps are shaded. `restarts` are the
// stamps, as written in the estimate, of the poses at which the odometry started anew; they are marked too.

/// Truth and aligned estimate seen from above, in m, equal axes, the start marked.
Figure TrajectoryFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                        const evaluation::AlignedEvaluation& result);

/// x, y and z of truth and aligned estimate over time, in m, in the truth's world frame, one panel each.
Figure AxesFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                  const evaluation::AlignedEvaluation& result, std::span<const TimeNs> restarts);

/// What errors are drawn over: the time since the start of the interval or the distance that the truth has travelled.
enum class ErrorAxis { kTime, kDistance };

/// Longitudinal, lateral (signed) and planar error in one panel, the vertical one in another, in m and % of the path.
Figure ErrorFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                   const evaluation::AlignedEvaluation& result, ErrorAxis axis, std::span<const TimeNs> restarts);

/// Local scale over time: 1 where the estimate has the scale of the alignment, more where it is too short.
Figure ScaleDriftFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                        const evaluation::AlignedEvaluation& result, std::span<const TimeNs> restarts);

/// Distribution of track lifetimes in frames with their mean.
Figure LifetimeFigure(const std::string& name, const evaluation::LifetimeStatistics& statistics);
/// The same in seconds.
Figure LifetimeSecondsFigure(const std::string& name, const evaluation::LifetimeStatistics& statistics);

/// Features seen in a frame.
struct LiveFeatures {
  TimeNs t = 0;
  std::int64_t features = 0;
};

/// Their number over the time since the first of `frames`, with the mean over the frames.
Figure LiveFeaturesFigure(const std::string& name, std::span<const LiveFeatures> frames);

}  // namespace evo::report
