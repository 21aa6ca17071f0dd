#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "evo/report/figures.hpp"
#include "report/figures/figure_style.hpp"

namespace evo::report {

namespace {

/// Indices of the world axes of a top view; right x away points to the viewer.
struct MapAxes {
  int right = 0;
  int away = 1;
};

MapAxes ChooseMapAxes(const Eigen::Vector3d& up) {
  Eigen::Index axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  const int next = static_cast<int>(axis + 1) % 3;
  const int after = static_cast<int>(axis + 2) % 3;
  return up[axis] > 0.0 ? MapAxes{next, after} : MapAxes{after, next};
}

/// One index of a data file with seconds, x, y, z; an empty line interrupts the curve at a gap.
std::string TrajectoryRows(const geometry::Trajectory& trajectory, TimeNs start, TimeNs max_gap) {
  std::string data;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (i > 0 && trajectory[i].t - trajectory[i - 1].t > max_gap) data += '\n';
    const Eigen::Vector3d& p = trajectory[i].T_world_cam.translation();
    data += DataRow({ToSeconds(trajectory[i].t - start), p.x(), p.y(), p.z()});
  }
  return data;
}

std::string TrajectoryData(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result) {
  return fmt::format("# seconds, x, y, z (m); first index: ground truth, second: estimate ({} alignment)\n",
                     result.alignment.name) +
         TrajectoryRows(evaluation.truth, evaluation.from, std::numeric_limits<TimeNs>::max()) + "\n\n" +
         TrajectoryRows(result.aligned, evaluation.from, evaluation.max_gap);
}

/// Range of both trajectories along one world axis.
Range AxisRange(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result, int axis) {
  Range range;
  for (const geometry::Trajectory* trajectory : {&evaluation.truth, &result.aligned}) {
    for (const auto& pose : *trajectory) range.Add(pose.T_world_cam.translation()[axis]);
  }
  return range;
}

/// A `plot` command of truth and estimate for the given columns of the data file.
std::string PlotTrajectories(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result,
                             const std::string& columns, bool with_titles) {
  return fmt::format(
      "plot {}, \\\n  {}",
      PlotElements({"data index 0", evaluation.truth.size(), columns, kTruthStyle, with_titles ? "ground truth" : ""}),
      PlotElements({"data index 1", result.aligned.size(), columns, kEstimateStyle, with_titles ? "estimate" : ""}));
}

}  // namespace

Figure TrajectoryFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                        const evaluation::AlignedEvaluation& result) {
  const MapAxes axes = ChooseMapAxes(evaluation.up);
  Range right = AxisRange(evaluation, result, axes.right);
  Range away = AxisRange(evaluation, result, axes.away);
  // A straight road is long and thin; the map gets at least 0.4 of its length across.
  const double length = std::max(right.length(), away.length());
  for (Range* range : {&right, &away}) {
    range->WidenTo(std::max(0.4 * length, 1e-3));
    range->Pad();
  }

  Figure figure;
  figure.data = TrajectoryData(evaluation, result);
  figure.height = static_cast<int>(std::lround(std::clamp(760.0 * away.length() / right.length(), 340.0, 900.0))) + 140;
  const char* const names = "xyz";
  const std::string columns = fmt::format("{}:{}", axes.right + 2, axes.away + 2);
  figure.script = BeginFigure(fmt::format("Trajectory, top view ({} alignment)", result.alignment.name), figure.height);
  figure.script += fmt::format(
      "set size ratio -1\n"
      "set xrange {}\n"
      "set yrange {}\n"
      "set xlabel '{} (m)'\n"
      "set ylabel '{} (m)'\n"
      "data = '{}.dat'\n"
      "{}, \\\n"
      "  data index 1 every ::0:0:0:0 using {} with points pointtype 7 pointsize 1.1 linecolor '#000000' title "
      "'start'\n",
      FormatRange(right), FormatRange(away), names[axes.right], names[axes.away], name,
      PlotTrajectories(evaluation, result, columns, true), columns);
  return figure;
}

Figure AxesFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                  const evaluation::AlignedEvaluation& result, std::span<const TimeNs> reinitialisations) {
  const auto interruptions = FindInterruptions(evaluation, result, reinitialisations, &evaluation::PoseError::seconds);
  std::string script = BeginPanels(fmt::format("Position over time ({} alignment)", result.alignment.name));
  script += fmt::format("set xrange {}\n{}data = '{}.dat'\n", FormatRange(TimeRange(evaluation)),
                        DrawInterruptions(interruptions), name);
  for (int axis = 0; axis < 3; ++axis) {
    const bool first = axis == 0;
    const bool last = axis == 2;
    Range meters = AxisRange(evaluation, result, axis);
    meters.Pad();
    const double top = 0.11 + 0.27 * axis;
    script += Panel(top, top + 0.24, meters, fmt::format("{} (m)", "xyz"[axis]), last);
    if (last) script += fmt::format("set xlabel '{}'\n", TimeLabel(evaluation));
    script += PlotTrajectories(evaluation, result, fmt::format("1:{}", axis + 2), first);
    script += (first ? InterruptionLegend(interruptions) : "") + "\n";
    if (first) script += "unset label 3\n";
  }
  script += "unset multiplot\n";
  return {TrajectoryData(evaluation, result), script, 900, 700};
}

}  // namespace evo::report
