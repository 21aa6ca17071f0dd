#pragma once

#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "evo/evaluation/evaluation.hpp"
#include "evo/report/gnuplot.hpp"

namespace evo::report {

// Parts of gnuplot scripts that all figures share: colours, axes, data rows and marks.

// Colours of Okabe and Ito.
inline constexpr const char* kBlue = "#0072B2";
inline constexpr const char* kVermilion = "#D55E00";
inline constexpr const char* kSkyBlue = "#56B4E9";
inline constexpr const char* kPurple = "#CC79A7";
// The truth is wide and light under the thin dark estimate, so both differ in grey too.
inline constexpr const char* kTruthStyle = "linewidth 7 linecolor '#7DB7E8'";
inline constexpr const char* kEstimateStyle = "linewidth 2 linecolor '#00664A'";

/// Ten significant digits, "0" for -0.
std::string FormatNumber(double value);
/// A row of a data file.
std::string DataRow(std::initializer_list<double> values);

/// Style, title and legend of a figure with one panel; `height` is that of the figure (px).
std::string BeginFigure(const std::string& title, int height = Figure().height);

/// A curve that is interrupted at empty lines of the data file. Of many rows only a few thousand are drawn. Each piece
/// starts with a dot, so that a single row between two gaps is visible.
struct Curve {
  std::string data;  ///< file and, if there are several, index
  std::size_t rows;
  std::string columns;  ///< of `using`
  std::string style;    ///< width, colour and dashes
  std::string title;    ///< in the legend; none if empty
};
/// The elements of a `plot` command for a curve.
std::string PlotElements(const Curve& curve);

/// An interval of an axis.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void Add(double value);
  double length() const { return high - low; }
  /// Widens the range about its middle to at least `wanted`; an empty range starts from [0, 0].
  void WidenTo(double wanted);
  /// Adds a margin; the range is never empty after that, because gnuplot refuses an empty one.
  void Pad();
};

/// "[low:high]".
std::string FormatRange(const Range& range);

/// The distance between tics, 1, 2 or 5 times a power of ten with at most five steps in the range.
double TicStep(const Range& range);

/// Style, title and legend of a figure of panels that share the horizontal axis.
std::string BeginPanels(const std::string& title);
/// The next panel: its place in the figure's height (from the top, in [0, 1]) and its vertical axis; only the `last`
/// one has labels on the horizontal axis.
std::string Panel(double top, double bottom, const Range& range, const std::string& label, bool last);

/// Places on the horizontal axis where the estimate is missing and where the odometry reinitialised.
struct Interruptions {
  std::vector<Range> gaps;
  std::vector<double> reinitialisations;
};

/// `axis` is &PoseError::seconds or &PoseError::distance. Gaps before the first pose and after the last one exist only
/// in time.
Interruptions FindInterruptions(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result,
                                std::span<const TimeNs> reinitialisations, double evaluation::PoseError::*axis);
/// Shades gaps and draws a line at each reinitialisation.
std::string DrawInterruptions(const Interruptions& interruptions);
/// Elements of the `plot` command for their entries in the legend, if there are any.
std::string InterruptionLegend(const Interruptions& interruptions);

/// The evaluated interval (s).
Range TimeRange(const evaluation::Evaluation& evaluation);
/// Label of a time axis; without stamps its "seconds" are numbers of frames.
std::string TimeLabel(const evaluation::Evaluation& evaluation);

}  // namespace evo::report
