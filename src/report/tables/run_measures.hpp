#pragma once

#include <optional>
#include <string>
#include <vector>

namespace evo::report {

/// A number that tables of runs show, and how.
struct RunMeasure {
  const char* column;   ///< in runs.csv
  const char* heading;  ///< as HTML and LaTeX both understand it
  const char* unit;     ///< "%", "m", ...
  double factor;        ///< from the column's unit to the one shown
  int decimals;
};

/// The columns of the short tables, in order.
const std::vector<RunMeasure>& RunMeasures();

/// Empty unless `text` is entirely a finite number.
std::optional<double> ParseMeasure(const std::string& text);

/// The number of a cell in the unit and with the decimals of its measure; "" if the cell has none.
std::string FormatMeasure(const RunMeasure& measure, const std::string& cell);

}  // namespace evo::report
