#include "evo/report/latex_tables.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <functional>
#include <limits>

#include "report/tables/latex.hpp"

namespace evo::report {

namespace {

constexpr int kDecimals = 4;

std::string Cell(double value, int decimals = kDecimals) {
  if (!std::isfinite(value)) return "--";
  const double half_digit = 0.5 * std::pow(10.0, -decimals);
  return fmt::format("${:.{}f}$", std::abs(value) < half_digit ? 0.0 : value, decimals);
}

std::string Number(double value, int decimals) {
  const std::string cell = Cell(value, decimals);
  return cell.starts_with('$') ? cell.substr(1, cell.size() - 2) : cell;
}

/// A label without special characters of TeX.
std::string Label(std::string name) {
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '-';
  }
  return name;
}

std::string Begin(const std::string& caption, const std::string& label, const std::string& columns) {
  return "% needs \\usepackage{booktabs}\n\\begin{table}\n  \\centering\n  \\caption{" + caption +
         "}\n  \\label{tab:" + label + "}\n  \\begin{tabular}{" + columns + "}\n    \\toprule\n";
}

std::string End() { return "    \\bottomrule\n  \\end{tabular}\n\\end{table}\n"; }

std::string ErrorRow(const std::string& item, const evaluation::AlignedEvaluation& result,
                     const std::function<double(const evaluation::ErrorSummary&)>& value) {
  return "    " + item + " & " + Cell(value(result.longitudinal)) + " & " + Cell(value(result.lateral)) + " & " +
         Cell(value(result.planar)) + " \\\\\n";
}

std::string AlignmentBlock(const evaluation::Evaluation& evaluation, const evaluation::AlignedEvaluation& result) {
  const double percent = evaluation.path_m > 0.0 ? 100.0 / evaluation.path_m : std::numeric_limits<double>::quiet_NaN();
  return "    \\midrule\n    \\multicolumn{4}{l}{Alignment " + LatexEscape(result.alignment.name) + ", scale " +
         Number(result.similarity.scale, 5) + ", " + std::to_string(result.errors.size()) + " poses} \\\\\n" +
         ErrorRow("Average error, mean absolute (m)", result,
                  [](const evaluation::ErrorSummary& error) { return error.mean_abs; }) +
         ErrorRow("Relative error, largest/path (\\%)", result,
                  [&](const evaluation::ErrorSummary& error) { return percent * error.max_abs; }) +
         ErrorRow("Average error/path (\\%)", result,
                  [&](const evaluation::ErrorSummary& error) { return percent * error.mean_abs; }) +
         ErrorRow("Mean of error/distance travelled (\\%)", result,
                  [](const evaluation::ErrorSummary& error) { return 100.0 * error.mean_over_distance; }) +
         ErrorRow("Root mean square error (m)", result,
                  [](const evaluation::ErrorSummary& error) { return error.rmse; }) +
         ErrorRow("Largest error (m)", result, [](const evaluation::ErrorSummary& error) { return error.max_abs; }) +
         ErrorRow("Final error, signed (m)", result, [](const evaluation::ErrorSummary& error) { return error.final; });
}

}  // namespace

std::string LifetimeTable(const std::string& sequence, const evaluation::LifetimeStatistics& statistics) {
  const double rate = 1.0 / statistics.frame_interval_s;  // infinite without an interval
  const std::string caption = fmt::format(
      "Lifetime of the feature tracks of {}: {} tracks in {} event frames at {}\\,Hz; tracks of fewer than {} frames "
      "are "
      "left out.",
      LatexEscape(sequence), statistics.tracks, statistics.frames, Number(rate, 1), evaluation::kMinLifetimeFrames);
  const auto& frames = statistics.in_frames;
  const auto& seconds = statistics.in_seconds;
  return Begin(caption, "lifetime-" + Label(sequence), "lr") + "    Item & Value \\\\\n    \\midrule\n" +
         "    Average lifetime (frames) & " + Cell(frames.mean, 3) + " \\\\\n" + "    Standard deviation (frames) & " +
         Cell(frames.standard_deviation, 3) + " \\\\\n" + "    Average lifetime (s) & " + Cell(seconds.mean, 3) +
         " \\\\\n" + "    Standard deviation (s) & " + Cell(seconds.standard_deviation, 3) + " \\\\\n" + End();
}

std::string ErrorTable(const std::string& sequence, const evaluation::Evaluation& evaluation) {
  const std::string caption =
      fmt::format("Position error of the estimate for {}: a path of {}\\,m in {}\\,s, coverage {}\\,\\%.",
                  LatexEscape(sequence), Number(evaluation.path_m, 1),
                  Number(ToSeconds(evaluation.to - evaluation.from), 1), Number(100.0 * evaluation.coverage, 1));
  std::string table =
      Begin(caption, "errors-" + Label(sequence), "lrrr") + "    Item & Longitudinal & Lateral & Planar \\\\\n";
  for (const auto& result : evaluation.alignments) table += AlignmentBlock(evaluation, result);
  return table + End();
}

}  // namespace evo::report
