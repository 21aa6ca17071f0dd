#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "evo/report/figures.hpp"
#include "report/figures/figure_style.hpp"

namespace evo::report {

namespace {

/// The two axes of the world that span the ground as seen from above: right x away = towards the viewer.
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

/// One index of a data file: seconds, x, y, z; an empty line breaks the curve at a gap.
void AppendTrack(std::ostream& data, const geometry::Trajectory& track, TimeNs start, TimeNs longest_gap) {
  for (std::size_t i = 0; i < track.size(); ++i) {
    if (i > 0 && track[i].t - track[i - 1].t > longest_gap) data << '\n';
    const Eigen::Vector3d& p = track[i].T_world_cam.translation();
    AppendRow(data, {ToSeconds(track[i].t - start), p.x(), p.y(), p.z()});
  }
}

std::string TrackData(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result) {
  std::ostringstream data;
  data << "# seconds, x, y, z (m); first part: ground truth, second: estimate (" << result.alignment.name << ")\n";
  AppendTrack(data, evaluation.truth, evaluation.from, std::numeric_limits<TimeNs>::max());
  data << "\n\n";
  AppendTrack(data, result.aligned, evaluation.from, evaluation.longest_gap);
  return data.str();
}

/// The stretch of one axis of the world that both trajectories fill.
Range AxisRange(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result, int axis) {
  Range range;
  for (const geometry::Trajectory* track : {&evaluation.truth, &result.aligned}) {
    for (const auto& pose : *track) range.Add(pose.T_world_cam.translation()[axis]);
  }
  return range;
}

/// `plot` of truth and estimate, by their columns in the data file.
std::string PlotTracks(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result,
                       const std::string& columns, bool with_titles) {
  const auto title = [&](const std::string& text) { return with_titles ? text : std::string(); };
  std::ostringstream plot;
  plot << "plot " << Curve{"data index 0", evaluation.truth.size(), columns, kTruthStyle, title("ground truth")}
       << ", \\\n  "
       << Curve{"data index 1", result.aligned.size(), columns, kEstimateStyle,
                title("estimate (" + result.alignment.name + ")")};
  return plot.str();
}

}  // namespace

Figure TrajectoryFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                        const evaluation::AlignedEvaluation& result) {
  const MapAxes axes = ChooseMapAxes(evaluation.up);
  Range right = AxisRange(evaluation, result, axes.right);
  Range away = AxisRange(evaluation, result, axes.away);
  // A straight road is long and thin: leave it room to be seen.
  const double length = std::max(right.length(), away.length());
  for (Range* range : {&right, &away}) {
    range->WidenTo(std::max(0.4 * length, 1e-3));
    range->Pad();
  }

  Figure figure;
  figure.data = TrackData(evaluation, result);
  figure.height = static_cast<int>(std::lround(std::clamp(760.0 * away.length() / right.length(), 340.0, 900.0))) + 140;
  const char* const names = "xyz";
  const std::string columns = std::to_string(axes.right + 2) + ":" + std::to_string(axes.away + 2);
  std::ostringstream script;
  script << kStyle << "set size ratio -1\n"
         << "set xrange " << right << "\n"
         << "set yrange " << away << "\n"
         << "set xlabel '" << names[axes.right] << " (m)'\n"
         << "set ylabel '" << names[axes.away] << " (m)'\n"
         << "data = '" << name << ".dat'\n"
         << PlotTracks(evaluation, result, columns, true) << ", \\\n  data index 1 every ::0:0:0:0 using " << columns
         << " with points pointtype 7 pointsize 1.1 linecolor '#000000' title 'start'\n";
  figure.script = script.str();
  return figure;
}

Figure AxesFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                  const evaluation::AlignedEvaluation& result, std::span<const TimeNs> restarts) {
  const auto interruptions = FindInterruptions(evaluation, result, restarts, &evaluation::PoseError::seconds);
  std::ostringstream script;
  script << BeginPanels() << "set xrange " << TimeRange(evaluation) << "\n"
         << DrawInterruptions(interruptions) << "data = '" << name << ".dat'\n";
  for (int axis = 0; axis < 3; ++axis) {
    Range meters = AxisRange(evaluation, result, axis);
    meters.Pad();
    const double top = 0.08 + 0.275 * axis;
    script << Panel(top, top + 0.25, meters, std::string(1, "xyz"[axis]) + " (m)", axis == 2);
    if (axis == 2) script << "set xlabel '" << TimeLabel(evaluation) << "'\n";
    script << PlotTracks(evaluation, result, "1:" + std::to_string(axis + 2), axis == 0)
           << (axis == 0 ? ExplainInterruptions(interruptions) : "") << "\n";
  }
  script << "unset multiplot\n";
  return {TrackData(evaluation, result), script.str(), 900, 700};
}

}  // namespace evo::report
