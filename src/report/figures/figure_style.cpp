#include "report/figures/figure_style.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace evo::report {

namespace {

constexpr std::size_t kMostPoints = 5000;

constexpr const char* kGapColor = "#e6e6e6";
constexpr const char* kRestartStyle = "linewidth 2 dashtype (2,4) linecolor '#707070'";

}  // namespace

std::string Print(const char* format, double value) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string Number(double value) { return Print("%.10g", value == 0.0 ? 0.0 : value); }

void AppendRow(std::ostream& data, std::initializer_list<double> values) {
  const char* separator = "";
  for (const double value : values) {
    data << separator << Number(value);
    separator = " ";
  }
  data << '\n';
}

std::ostream& operator<<(std::ostream& out, const Curve& curve) {
  out << curve.data;
  if (curve.rows > kMostPoints) out << " every " << (curve.rows + kMostPoints - 1) / kMostPoints;
  return out << " using " << curve.columns << " with lines " << curve.style
             << (curve.title.empty() ? " notitle" : " title '" + curve.title + "'") << ", \\\n  " << curve.data
             << " every ::0::0 using " << curve.columns << " with points pointtype 7 pointsize 0.45 " << curve.style
             << " notitle";
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
  WidenTo(0.0);
  const double size = std::max(std::abs(low), std::abs(high));
  WidenTo(std::max({1.1 * length(), 1e-6, 1e-6 * size}));  // a micrometre, and more than Number leaves of large values
}

std::ostream& operator<<(std::ostream& out, const Range& range) {
  return out << '[' << Number(range.low) << ':' << Number(range.high) << ']';
}

double TicStep(const Range& range) {
  constexpr double kMostSteps = 5.0;
  const double decade = std::pow(10.0, std::floor(std::log10(range.length() / kMostSteps)));
  for (const double step : {decade, 2.0 * decade, 5.0 * decade}) {
    if (range.length() <= kMostSteps * step) return step;
  }
  return 10.0 * decade;
}

std::string BeginPanels() {
  return std::string(kStyle) +
         "set multiplot\n"
         "set key at screen 0.5, screen 0.99 center top width -2 font ',12'\n"
         "set lmargin at screen 0.12\n"
         "set rmargin at screen 0.97\n";
}

std::string Panel(double top, double bottom, const Range& range, const std::string& label, bool last) {
  std::ostringstream script;
  script << "set tmargin at screen " << Number(1.0 - top) << "\n"
         << "set bmargin at screen " << Number(1.0 - bottom) << "\n"
         << "set yrange " << range << "\n"
         << "set ytics " << Number(TicStep(range))
         << "\n"
         // Unlike ylabel this stays in the picture however wide the numbers are, and lines up with the other panels.
         << "set label 1 '" << label << "' at screen 0.015, graph 0.5 center rotate\n"
         << (last ? "set format x '% h'\n" : "set format x ''\n");
  return script.str();
}

Interruptions FindInterruptions(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result,
                                std::span<const TimeNs> restarts, double evaluation::PoseError::*axis) {
  Interruptions found;
  const auto& errors = result.errors;
  for (std::size_t i = 1; i < errors.size(); ++i) {
    if (errors[i].stamp - errors[i - 1].stamp > evaluation.longest_gap) {
      found.gaps.push_back({errors[i - 1].*axis, errors[i].*axis});
    }
  }
  if (axis == &evaluation::PoseError::seconds) {
    const double longest = ToSeconds(evaluation.longest_gap);
    const double end = ToSeconds(evaluation.to - evaluation.from);
    if (errors.front().seconds > longest) found.gaps.push_back({0.0, errors.front().seconds});
    if (end - errors.back().seconds > longest) found.gaps.push_back({errors.back().seconds, end});
  }
  for (const TimeNs restart : restarts) {
    const auto error = std::ranges::lower_bound(errors, restart, {}, &evaluation::PoseError::stamp);
    if (error != errors.end()) found.restarts.push_back((*error).*axis);
  }
  return found;
}

std::string DrawInterruptions(const Interruptions& interruptions) {
  std::ostringstream script;
  for (const auto& gap : interruptions.gaps) {
    script << "set object rectangle from " << Number(gap.low) << ", graph 0 to " << Number(gap.high)
           << ", graph 1 behind fillcolor '" << kGapColor << "' fillstyle solid noborder\n";
  }
  for (const double restart : interruptions.restarts) {
    script << "set arrow from " << Number(restart) << ", graph 0 to " << Number(restart) << ", graph 1 nohead back "
           << kRestartStyle << "\n";
  }
  return script.str();
}

std::string ExplainInterruptions(const Interruptions& interruptions) {
  std::string elements;
  if (!interruptions.gaps.empty()) {
    elements +=
        std::string(", \\\n  NaN with boxes fillstyle solid noborder linecolor '") + kGapColor + "' title 'no pose'";
  }
  if (!interruptions.restarts.empty()) {
    elements += std::string(", \\\n  NaN with lines ") + kRestartStyle + " title 'started anew'";
  }
  return elements;
}

Range TimeRange(const evaluation::Evaluation& evaluation) {
  Range time{0.0, ToSeconds(evaluation.to - evaluation.from)};
  time.WidenTo(1e-3);
  return time;
}

std::string TimeLabel(const evaluation::Evaluation& evaluation) { return evaluation.has_stamps ? "time (s)" : "frame"; }

}  // namespace evo::report
