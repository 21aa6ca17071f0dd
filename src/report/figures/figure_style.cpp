#include "report/figures/figure_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evo::report {

namespace {

constexpr std::size_t kMaxPoints = 5000;  // more slow down viewers and add nothing visible
constexpr double kMaxTicSteps = 5.0;

constexpr const char* kGapColor = "#e6e6e6";
constexpr const char* kReinitialisationStyle = "linewidth 2 dashtype (2,4) linecolor '#707070'";

constexpr const char* kStyle =
    "set border 3 linecolor '#404040'\n"
    "set tics out nomirror textcolor '#202020'\n"
    "set grid linecolor '#d8d8d8' linetype 1 linewidth 0.5\n";

}  // namespace

std::string FormatNumber(double value) { return fmt::format("{:.10g}", value == 0.0 ? 0.0 : value); }

std::string DataRow(std::initializer_list<double> values) {
  std::string row;
  for (const double value : values) {
    if (!row.empty()) row += ' ';
    row += FormatNumber(value);
  }
  return row + '\n';
}

std::string BeginFigure(const std::string& title, int height) {
  // `set title` would place the title below the legend.
  const auto from_top = [&](double px) { return FormatNumber(1.0 - px / height); };
  return fmt::format(
      "{}set label 3 '{}' at screen 0.5, screen {} center font ',16'\n"
      "set key at screen 0.5, screen {} center top horizontal maxrows 1 samplen 2.5\n"
      "set tmargin at screen {}\n",
      kStyle, title, from_top(18.0), from_top(34.0), from_top(70.0));
}

std::string PlotElements(const Curve& curve) {
  const std::string every = curve.rows > kMaxPoints ? fmt::format(" every {}", (curve.rows - 1) / kMaxPoints + 1) : "";
  const std::string title = curve.title.empty() ? "notitle" : "title '" + curve.title + "'";
  return fmt::format(
      "{0}{1} using {2} with lines {3} {4}, \\\n"
      "  {0} every ::0::0 using {2} with points pointtype 7 pointsize 0.45 {3} notitle",
      curve.data, every, curve.columns, curve.style, title);
}

void Range::Add(double value) {
  low = std::min(low, value);
  high = std::max(high, value);
}

void Range::WidenTo(double wanted) {
  if (low > high) low = high = 0.0;
  const double missing = std::max(0.0, wanted - length());
  low -= 0.5 * missing;
  high += 0.5 * missing;
}

void Range::Pad() {
  constexpr double kMinLength = 1e-6;          // a micrometre
  constexpr double kMinRelativeLength = 1e-6;  // more than FormatNumber rounds off large values
  WidenTo(0.0);
  const double size = std::max(std::abs(low), std::abs(high));
  WidenTo(std::max({1.1 * length(), kMinLength, kMinRelativeLength * size}));
}

std::string FormatRange(const Range& range) {
  return fmt::format("[{}:{}]", FormatNumber(range.low), FormatNumber(range.high));
}

double TicStep(const Range& range) {
  const double decade = std::pow(10.0, std::floor(std::log10(range.length() / kMaxTicSteps)));
  for (const double step : {decade, 2.0 * decade, 5.0 * decade}) {
    if (range.length() <= kMaxTicSteps * step) return step;
  }
  return 10.0 * decade;
}

std::string BeginPanels(const std::string& title) {
  return fmt::format(
      "{}set multiplot\n"
      "set label 3 '{}' at screen 0.5, screen 0.975 center font ',16'\n"
      "set key at screen 0.5, screen 0.945 center top horizontal maxrows 1 samplen 2.5 width -2 font ',12'\n"
      "set lmargin at screen 0.12\n"
      "set rmargin at screen 0.97\n",
      kStyle, title);
}

std::string Panel(double top, double bottom, const Range& range, const std::string& label, bool last) {
  // Unlike ylabel, label 1 stays in the picture however wide the numbers are, and it lines up with the other panels.
  return fmt::format(
      "set tmargin at screen {}\n"
      "set bmargin at screen {}\n"
      "set yrange {}\n"
      "set ytics {}\n"
      "set label 1 '{}' at screen 0.015, graph 0.5 center rotate\n"
      "set format x '{}'\n",
      FormatNumber(1.0 - top), FormatNumber(1.0 - bottom), FormatRange(range), FormatNumber(TicStep(range)), label,
      last ? "% h" : "");
}

Interruptions FindInterruptions(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result,
                                std::span<const TimeNs> reinitialisations, double evaluation::PoseError::*axis) {
  Interruptions found;
  const auto& errors = result.errors;
  for (std::size_t i = 1; i < errors.size(); ++i) {
    if (errors[i].stamp - errors[i - 1].stamp > evaluation.max_gap) {
      found.gaps.push_back({errors[i - 1].*axis, errors[i].*axis});
    }
  }
  if (axis == &evaluation::PoseError::seconds) {
    const double max_gap = ToSeconds(evaluation.max_gap);
    const double end = ToSeconds(evaluation.to - evaluation.from);
    if (errors.front().seconds > max_gap) found.gaps.push_back({0.0, errors.front().seconds});
    if (end - errors.back().seconds > max_gap) found.gaps.push_back({errors.back().seconds, end});
  }
  for (const TimeNs stamp : reinitialisations) {
    const auto error = std::ranges::lower_bound(errors, stamp, {}, &evaluation::PoseError::stamp);
    if (error != errors.end()) found.reinitialisations.push_back((*error).*axis);
  }
  return found;
}

std::string DrawInterruptions(const Interruptions& interruptions) {
  std::string script;
  for (const auto& gap : interruptions.gaps) {
    script += fmt::format(
        "set object rectangle from {}, graph 0 to {}, graph 1 behind fillcolor '{}' fillstyle solid noborder\n",
        FormatNumber(gap.low), FormatNumber(gap.high), kGapColor);
  }
  for (const double place : interruptions.reinitialisations) {
    script += fmt::format("set arrow from {0}, graph 0 to {0}, graph 1 nohead back {1}\n", FormatNumber(place),
                          kReinitialisationStyle);
  }
  return script;
}

std::string InterruptionLegend(const Interruptions& interruptions) {
  std::string elements;
  if (!interruptions.gaps.empty()) {
    elements +=
        fmt::format(", \\\n  NaN with boxes fillstyle solid noborder linecolor '{}' title 'no pose'", kGapColor);
  }
  if (!interruptions.reinitialisations.empty()) {
    elements += fmt::format(", \\\n  NaN with lines {} title 'reinitialised'", kReinitialisationStyle);
  }
  return elements;
}

Range TimeRange(const evaluation::Evaluation& evaluation) {
  Range time{0.0, ToSeconds(evaluation.to - evaluation.from)};
  time.WidenTo(1e-3);
  return time;
}

std::string TimeLabel(const evaluation::Evaluation& evaluation) {
  return evaluation.has_stamps ? "time (s)" : "frame (number)";
}

}  // namespace evo::report
