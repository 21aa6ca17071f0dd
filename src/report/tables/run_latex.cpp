#include <fmt/format.h>

#include "evo/report/run_table.hpp"
#include "report/tables/latex.hpp"
#include "report/tables/run_measures.hpp"

namespace evo::report {

namespace {

/// "" without such a column.
std::string Cell(const CsvTable& table, std::size_t row, const std::string& column) {
  const auto found = table.Find(column);
  return found ? table.rows[row][*found] : "";
}

std::string Header(const std::string& alignment) {
  const auto& measures = RunMeasures();
  std::string text = "% A row a run" + (alignment.empty() ? "" : "; alignment " + alignment) +
                     ". Errors are means of absolute values, in m and in % of the path.\n"
                     "% Needs \\usepackage{booktabs}.\n\\begin{tabular}{l" +
                     std::string(measures.size(), 'r') + "}\n\\toprule\nRun";
  for (const auto& measure : measures) text += std::string(" & ") + measure.heading;
  text += " \\\\\n";
  for (const auto& measure : measures) text += " & (" + LatexEscape(measure.unit) + ")";
  return text + " \\\\\n\\midrule\n";
}

/// A text in place of all measures; its lines may break at slashes.
std::string TextCell(const std::string& text) {
  std::string breakable;
  for (const char c : LatexEscape(text)) breakable += c == '/' ? "/\\allowbreak{}" : std::string(1, c);
  return fmt::format(" & \\multicolumn{{{}}}{{p{{0.6\\linewidth}}}}{{\\raggedright {}}}", RunMeasures().size(),
                     breakable);
}

std::string Numbers(const CsvTable& runs, std::size_t row) {
  std::string text;
  for (const auto& measure : RunMeasures()) {
    const std::string number = FormatMeasure(measure, Cell(runs, row, measure.column));
    text += " & " + (number.empty() ? "--" : number);
  }
  return text;
}

}  // namespace

std::string RunsLatex(const CsvTable& runs, const std::string& alignment) {
  std::string text = Header(alignment);
  for (std::size_t begin = 0; begin < runs.rows.size();) {
    const std::string run = Cell(runs, begin, "run");
    std::size_t end = begin;
    std::size_t chosen = runs.rows.size();
    for (; end < runs.rows.size() && Cell(runs, end, "run") == run; ++end) {
      const std::string name = Cell(runs, end, "alignment");
      if (name == alignment || name.empty()) chosen = end;  // a run without evaluation has lifetimes only
    }
    text += LatexEscape(run);
    if (Cell(runs, begin, "status") == "failed") {
      text += TextCell("failed: " + Cell(runs, begin, "failure"));
    } else {
      text += chosen < end ? Numbers(runs, chosen) : TextCell("no alignment " + alignment);
    }
    text += " \\\\\n";
    begin = end;
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace evo::report
