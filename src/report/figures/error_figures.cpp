#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "evo/report/figures.hpp"
#include "report/figures/figure_style.hpp"

namespace evo::report {

namespace {

/// Seconds, distance and errors; an empty line interrupts the curves at a gap.
std::string ErrorData(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result) {
  std::string data =
      fmt::format("# seconds, distance (m), longitudinal (m), lateral (m), planar (m), vertical (m); alignment {}\n",
                  result.alignment.name);
  for (std::size_t i = 0; i < result.errors.size(); ++i) {
    const auto& error = result.errors[i];
    if (i > 0 && error.stamp - result.errors[i - 1].stamp > evaluation.max_gap) data += '\n';
    data += DataRow({error.seconds, error.distance, error.position.longitudinal, error.position.lateral,
                     error.position.planar, error.position.vertical});
  }
  return data;
}

/// The right axis of a panel, in percent of the path, if there is a path.
std::string PercentAxis(const evaluation::Evaluation& evaluation, const Range& meters) {
  if (evaluation.path_m <= 0.0) return "";
  const double scale = 100.0 / evaluation.path_m;
  const Range percent{scale * meters.low, scale * meters.high};
  return fmt::format("set y2range {}\nset y2tics nomirror {} textcolor '#202020'\n", FormatRange(percent),
                     FormatNumber(TicStep(percent)));
}

struct ErrorRanges {
  Range planar;  ///< of longitudinal, lateral and planar errors (m)
  Range vertical;
};

ErrorRanges FindErrorRanges(const evaluation::AlignedEvaluation& result) {
  ErrorRanges ranges;
  for (const auto& error : result.errors) {
    const auto& position = error.position;
    for (const double value : {position.longitudinal, position.lateral, position.planar}) ranges.planar.Add(value);
    ranges.vertical.Add(position.vertical);
  }
  for (Range* range : {&ranges.planar, &ranges.vertical}) {
    range->Add(0.0);
    range->Pad();
  }
  return ranges;
}

}  // namespace

Figure ErrorFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                   const evaluation::AlignedEvaluation& result, ErrorAxis axis,
                   std::span<const TimeNs> reinitialisations) {
  const bool over_time = axis == ErrorAxis::kTime;
  const auto interruptions =
      FindInterruptions(evaluation, result, reinitialisations,
                        over_time ? &evaluation::PoseError::seconds : &evaluation::PoseError::distance);
  Range horizontal = over_time ? TimeRange(evaluation) : Range{0.0, evaluation.path_m};
  horizontal.WidenTo(1e-3);
  const ErrorRanges ranges = FindErrorRanges(result);
  const auto curve = [&](const char* column, const std::string& style, const std::string& title) {
    return PlotElements({"data", result.errors.size(), (over_time ? "1:" : "2:") + std::string(column), style, title});
  };

  std::string script = BeginPanels(fmt::format("Position error over {} ({} alignment)",
                                               over_time ? "time" : "distance travelled", result.alignment.name));
  script += fmt::format(
      "set rmargin at screen 0.88\n"
      "set xrange {}\n"
      "set xzeroaxis linetype 1 linewidth 1 linecolor '#808080'\n"
      "{}",
      FormatRange(horizontal), DrawInterruptions(interruptions));
  if (evaluation.path_m > 0.0) {
    script += fmt::format(
        "set border 11 linecolor '#404040'\n"
        "set label 2 'error (% of the path length, {:.4g} m)' at screen 0.985, screen 0.5 center rotate\n",
        evaluation.path_m);
  }
  script += fmt::format("data = '{}.dat'\n", name);
  script += Panel(0.125, 0.635, ranges.planar, "position error (m)", false) + PercentAxis(evaluation, ranges.planar);
  script +=
      fmt::format("plot {}, \\\n  {}, \\\n  {}{}\n", curve("5", "linewidth 3 linecolor '#000000'", "planar"),
                  curve("3", fmt::format("linewidth 2 linecolor '{}'", kBlue), "longitudinal (+ ahead)"),
                  curve("4", fmt::format("linewidth 2 dashtype (8,4) linecolor '{}'", kVermilion), "lateral (+ left)"),
                  InterruptionLegend(interruptions));
  script += "unset label 2\nunset label 3\n";
  script += Panel(0.675, 0.88, ranges.vertical, "vertical error (m)", true) + PercentAxis(evaluation, ranges.vertical);
  script += fmt::format("set xlabel '{}'\nplot {}\nunset multiplot\n",
                        over_time ? TimeLabel(evaluation) : "distance travelled (m)",
                        curve("6", fmt::format("linewidth 2 linecolor '{}'", kPurple), ""));
  return {ErrorData(evaluation, result), script, 900, 620};
}

Figure ScaleDriftFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                        const evaluation::AlignedEvaluation& result, std::span<const TimeNs> reinitialisations) {
  const auto& samples = result.segments.local_scale;
  std::string data = fmt::format("# seconds, distance (m), local scale: true size / aligned size; alignment {}\n",
                                 result.alignment.name);
  Range ratio{0.99, 1.01};
  double last = -std::numeric_limits<double>::infinity();
  for (const auto& sample : samples) {
    if (!std::isfinite(sample.ratio)) continue;
    if (sample.seconds - last > ToSeconds(evaluation.max_gap)) data += '\n';
    data += DataRow({sample.seconds, sample.distance, sample.ratio});
    ratio.Add(sample.ratio);
    last = sample.seconds;
  }
  ratio.Pad();
  const auto interruptions = FindInterruptions(evaluation, result, reinitialisations, &evaluation::PoseError::seconds);
  std::string script = BeginFigure(fmt::format("Scale drift ({} alignment)", result.alignment.name));
  script += fmt::format(
      "set xrange {}\n"
      "set yrange {}\n"
      "set xlabel '{}'\n"
      "set ylabel 'local scale, true / estimated (ratio)'\n"
      "{}"
      "plot 1 with lines linewidth 1 linecolor '#808080' title 'no drift', \\\n  {}{}\n",
      FormatRange(TimeRange(evaluation)), FormatRange(ratio), TimeLabel(evaluation), DrawInterruptions(interruptions),
      PlotElements({"'" + name + ".dat'", samples.size(), "1:3", fmt::format("linewidth 2 linecolor '{}'", kBlue),
                    "local scale"}),
      InterruptionLegend(interruptions));
  return {data, script};
}

}  // namespace evo::report
