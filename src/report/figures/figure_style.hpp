#pragma once

#include <initializer_list>
#include <limits>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "evo/evaluation/evaluation.hpp"

namespace evo::report {

// What the figures share: colours, axes, data rows and marks, as pieces of gnuplot's language.

// Okabe & Ito.
inline constexpr const char* kBlue = "#0072B2";
inline constexpr const char* kVermilion = "#D55E00";
inline constexpr const char* kSkyBlue = "#56B4E9";
inline constexpr const char* kPurple = "#CC79A7";
// The truth lies wide and light under the thin dark estimate: told apart in grey as well.
inline constexpr const char* kTruthStyle = "linewidth 7 linecolor '#7DB7E8'";
inline constexpr const char* kEstimateStyle = "linewidth 2 linecolor '#00664A'";

inline constexpr const char* kStyle =
    "set border 3 linecolor '#404040'\n"
    "set tics out nomirror textcolor '#202020'\n"
    "set grid linecolor '#d8d8d8' linetype 1 linewidth 0.5\n"
    "set key outside top center horizontal maxrows 1 samplen 2.5\n";

/// Ten significant digits, "0" for -0.
std::string Number(double value);
/// printf with one number.
std::string Print(const char* format, double value);
/// A row of a data file.
void AppendRow(std::ostream& data, std::initializer_list<double> values);

/// A curve that is broken at empty lines of the data: elements of a `plot` command. Of many rows only a few thousand
/// are drawn; the data file keeps them all. Each stretch begins with a dot: a row between two gaps is no line.
struct Curve {
  std::string data;  ///< the file, and its index if there are several
  std::size_t rows;
  std::string columns;  ///< of `using`
  std::string style;    ///< of line and dots: width, colour, dashes
  std::string title;    ///< in the legend; empty: none
};
std::ostream& operator<<(std::ostream& out, const Curve& curve);

/// An interval of an axis.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void Add(double value);
  double length() const { return high - low; }
  /// Makes the range `wanted` long, at least, about its middle; [0, 0] before that if nothing was added.
  void WidenTo(double wanted);
  /// Leaves a margin around the values and never an empty range, which gnuplot refuses.
  void Pad();
};

/// "[low:high]".
std::ostream& operator<<(std::ostream& out, const Range& range);

/// A round distance between tics, 1, 2 or 5 times a power of ten, that leaves at most five steps in the range.
double TicStep(const Range& range);

/// Begins a figure of panels that share one horizontal axis, with one legend above them.
std::string BeginPanels();
/// The next panel: its place in shares of the figure's height from the top, its vertical axis; only the `last` one has
/// labels below.
std::string Panel(double top, double bottom, const Range& range, const std::string& label, bool last);

/// Where the estimate is missing and where it started anew, along a horizontal axis.
struct Interruptions {
  std::vector<Range> gaps;
  std::vector<double> restarts;
};

/// `axis` is &PoseError::seconds or &PoseError::distance. Gaps before the first pose and after the last one exist only
/// in time.
Interruptions FindInterruptions(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result,
                                std::span<const TimeNs> restarts, double evaluation::PoseError::*axis);
/// Shades gaps and draws a line at each restart.
std::string DrawInterruptions(const Interruptions& interruptions);
/// What the legend says of them: more elements for the `plot` command, or nothing.
std::string ExplainInterruptions(const Interruptions& interruptions);

/// The whole interval that was judged, in seconds.
Range TimeRange(const evaluation::Evaluation& evaluation);
/// What to write below such an axis: where there are no stamps, "seconds" are numbers of frames.
std::string TimeLabel(const evaluation::Evaluation& evaluation);

}  // namespace evo::report
