#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "evo/report/figures.hpp"
#include "report/figures/figure_style.hpp"

namespace evo::report {

namespace {

/// Seconds, metres travelled and the errors; an empty line breaks the curves at a gap.
std::string ErrorData(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result) {
  std::ostringstream data;
  data << "# seconds, distance (m), longitudinal (m), lateral (m), planar (m), vertical (m); alignment "
       << result.alignment.name << "\n";
  for (std::size_t i = 0; i < result.errors.size(); ++i) {
    const auto& error = result.errors[i];
    if (i > 0 && error.stamp - result.errors[i - 1].stamp > evaluation.longest_gap) data << '\n';
    AppendRow(data, {error.seconds, error.distance, error.driving.longitudinal, error.driving.lateral,
                     error.driving.planar, error.driving.vertical});
  }
  return data.str();
}

/// The percent of the path beside a panel in metres, where there is a path.
std::string PercentAxis(const evaluation::Evaluation& evaluation, const Range& meters) {
  if (evaluation.path_m <= 0.0) return "";
  const double scale = 100.0 / evaluation.path_m;
  const Range percent{scale * meters.low, scale * meters.high};
  std::ostringstream script;
  script << "set y2range " << percent << "\n"
         << "set y2tics nomirror " << Number(TicStep(percent)) << " textcolor '#202020'\n";
  return script.str();
}

}  // namespace

Figure ErrorFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                   const evaluation::AlignedEvaluation& result, ErrorAxis axis, std::span<const TimeNs> restarts) {
  const bool over_time = axis == ErrorAxis::kTime;
  const auto interruptions = FindInterruptions(
      evaluation, result, restarts, over_time ? &evaluation::PoseError::seconds : &evaluation::PoseError::distance);
  Range along = over_time ? TimeRange(evaluation) : Range{0.0, evaluation.path_m};
  along.WidenTo(1e-3);
  Range planar;
  Range vertical;
  for (const auto& error : result.errors) {
    for (const double value : {error.driving.longitudinal, error.driving.lateral, error.driving.planar}) {
      planar.Add(value);
    }
    vertical.Add(error.driving.vertical);
  }
  planar.Add(0.0);
  vertical.Add(0.0);
  planar.Pad();
  vertical.Pad();

  const auto curve = [&](const std::string& column, const std::string& style, const std::string& title) {
    return Curve{"data", result.errors.size(), (over_time ? "1:" : "2:") + column, style, title};
  };
  const auto color = [](const char* hex) { return std::string("linecolor '") + hex + "'"; };
  std::ostringstream script;
  script << BeginPanels() << "set rmargin at screen 0.88\n"
         << "set xrange " << along << "\n"
         << "set xzeroaxis linetype 1 linewidth 1 linecolor '#808080'\n"
         << DrawInterruptions(interruptions);
  if (evaluation.path_m > 0.0) {
    script << "set border 11 linecolor '#404040'\n"
           << "set label 2 '% of the path of " << Print("%.4g", evaluation.path_m)
           << " m' at screen 0.985, screen 0.5 center rotate\n";
  }
  script << "data = '" << name << ".dat'\n"
         << Panel(0.115, 0.63, planar, "error of position (m)", false) << PercentAxis(evaluation, planar) << "plot "
         << curve("5", "linewidth 3 linecolor '#000000'", "planar") << ", \\\n  "
         << curve("3", "linewidth 2 " + color(kBlue), "longitudinal (+ ahead)") << ", \\\n  "
         << curve("4", "linewidth 2 dashtype (8,4) " + color(kVermilion), "lateral (+ left)")
         << ExplainInterruptions(interruptions) << "\n"
         << "unset label 2\n"
         << Panel(0.67, 0.88, vertical, "vertical (m)", true) << PercentAxis(evaluation, vertical) << "set xlabel '"
         << (over_time ? TimeLabel(evaluation) : "distance travelled (m)") << "'\n"
         << "plot " << curve("6", "linewidth 2 " + color(kPurple), "") << "\n"
         << "unset multiplot\n";
  return {ErrorData(evaluation, result), script.str(), 900, 620};
}

Figure ScaleDriftFigure(const std::string& name, const evaluation::Evaluation& evaluation,
                        const evaluation::AlignedEvaluation& result, std::span<const TimeNs> restarts) {
  const auto& samples = result.segments.local_scale;
  std::ostringstream data;
  data << "# seconds, distance (m), local scale: true size / aligned size; alignment " << result.alignment.name << "\n";
  Range ratio{0.99, 1.01};
  double last = -std::numeric_limits<double>::infinity();
  for (const auto& sample : samples) {
    if (!std::isfinite(sample.ratio)) continue;
    if (sample.seconds - last > ToSeconds(evaluation.longest_gap)) data << '\n';
    AppendRow(data, {sample.seconds, sample.distance, sample.ratio});
    ratio.Add(sample.ratio);
    last = sample.seconds;
  }
  ratio.Pad();
  const auto interruptions = FindInterruptions(evaluation, result, restarts, &evaluation::PoseError::seconds);
  std::ostringstream script;
  script << kStyle << "set xrange " << TimeRange(evaluation) << "\n"
         << "set yrange " << ratio << "\n"
         << "set xlabel '" << TimeLabel(evaluation) << "'\n"
         << "set ylabel 'true size / estimated size'\n"
         << DrawInterruptions(interruptions) << "plot 1 with lines linewidth 1 linecolor '#808080' notitle, \\\n"
         << "  "
         << Curve{"'" + name + ".dat'", samples.size(), "1:3", std::string("linewidth 2 linecolor '") + kBlue + "'",
                  "local scale (" + result.alignment.name + ")"}
         << ExplainInterruptions(interruptions) << "\n";
  return {data.str(), script.str()};
}

}  // namespace evo::report
