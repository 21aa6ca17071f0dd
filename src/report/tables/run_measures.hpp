#pragma once

#include <optional>
#include <string>
#include <vector>

namespace evo::report {

/// A number in tables of runs and its format.
struct RunMeasure {
  const char* column;   ///< in runs.csv
  const char* heading;  ///< valid in HTML and LaTeX
  const char* unit;     ///< "%", "m", ...
  double factor;        ///< from the column's unit to `unit`
  int decimals;
};

/// The columns of the short tables, in order.
const std::vector<RunMeasure>& RunMeasures();

/// Parses a finite number; empty for other texts.
std::optional<double> ParseMeasure(const std::string& text);

/// Formats the number of a cell in the unit of its measure; "" if the cell has no number.
std::string FormatMeasure(const RunMeasure& measure, const std::string& cell);

}  // namespace evo::report
