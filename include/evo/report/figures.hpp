#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "evo/evaluation/evaluation.hpp"
#include "evo/evaluation/lifetime.hpp"
#include "evo/evaluation/track_accuracy.hpp"
#include "evo/report/gnuplot.hpp"

namespace evo::report {

// `name` is the name under which the figure is drawn, see Gnuplot::Draw. Colours are those of Okabe and Ito, which
// colour-blind readers can tell apart; lines also differ in dashes and width for black-and-white print. Curves are
// interrupted where poses are missing for longer than `evaluation.max_gap`, and such gaps are shaded.
// `reinitialisations` are the stamps, as in the estimate, of the poses at which the odometry reinitialised; each is
// marked by a line.

/// Top view of truth and aligned estimate (m) with equal axes; the start is marked.
Figure TrajectoryFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                        const evaluation::AlignedEvaluation& result);

/// x, y and z of truth and aligned estimate over time (m, in the truth's world frame), one panel each.
Figure AxesFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                  const evaluation::AlignedEvaluation& result, std::span<const TimeNs> reinitialisations);

/// The horizontal axis of errors: time since the start of the interval, or distance travelled by the truth.
enum class ErrorAxis { kTime, kDistance };

/// Longitudinal and lateral (signed) and planar error in one panel, vertical error in another (m and % of the path).
Figure ErrorFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                   const evaluation::AlignedEvaluation& result, ErrorAxis axis,
                   std::span<const TimeNs> reinitialisations);

/// Local scale over time: 1 where the scale of the alignment holds, larger where the estimate is too short.
Figure ScaleDriftFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                        const evaluation::AlignedEvaluation& result, std::span<const TimeNs> reinitialisations);

/// Histogram of track lifetimes in frames with their mean.
Figure LifetimeFigure(const std::string& name, const evaluation::LifetimeStatistics& statistics);
/// The same in seconds.
Figure LifetimeSecondsFigure(const std::string& name, const evaluation::LifetimeStatistics& statistics);

/// Number of features observed in a frame.
struct LiveFeatures {
  TimeNs t = 0;
  std::int64_t features = 0;
};

/// Number of live features over the time since the first of `frames`, with the mean over the frames.
Figure LiveFeaturesFigure(const std::string& name, std::span<const LiveFeatures> frames);

/// Median and quartiles of the track error over the age of the tracks, with the number of tracks of each age.
Figure TrackErrorFigure(const std::string& name, const evaluation::TrackAccuracy& accuracy);

}  // namespace evo::report
