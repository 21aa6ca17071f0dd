#include "evo/report/run_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>

#include "evo/report/run_table.hpp"
#include "report/page/html.hpp"
#include "report/page/page_resources.hpp"
#include "report/page/run_diagnosis_section.hpp"
#include "report/page/run_pictures.hpp"
#include "report/tables/run_measures.hpp"

namespace evo::report {

namespace {

std::string Plural(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// "" without such a column.
std::string Cell(const CsvTable& table, std::size_t row, const std::string& column) {
  const auto found = table.Find(column);
  return found ? table.rows[row][*found] : "";
}

/// A link to the details of the run of that name.
std::string RunLink(const std::vector<RunFolder>& runs, const std::string& name) {
  const auto run = std::ranges::find(runs, name, &RunFolder::name);
  return RunLink(*run, static_cast<std::size_t>(run - runs.begin()) + 1);
}

/// Opens a table in a container that scrolls, also by keyboard.
std::string OpenTable(const std::string& label) {
  return fmt::format(
      "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{}\">\n<table "
      "class=\"sortable\">\n<thead><tr>",
      label);
}

const char* const kCloseTable = "</tbody>\n</table>\n</div>\n";

std::string FailureList(const std::vector<RunFolder>& runs) {
  std::string items;
  std::size_t failed = 0;
  for (const auto& run : runs) {
    if (run.failure.empty()) continue;
    ++failed;
    items += "<li>" + RunLink(runs, run.name) + ": " + HtmlEscape(run.failure) + "</li>\n";
  }
  if (failed == 0) return "";
  return fmt::format("<section class=\"failures\">\n<h2>{} failed</h2>\n<ul>\n{}</ul>\n</section>\n",
                     Plural(failed, "run"), items);
}

std::string MeasureCells(const CsvTable& table, std::size_t row) {
  std::string cells = "<td>" + HtmlEscape(Cell(table, row, "alignment")) + "</td>";
  for (const auto& measure : RunMeasures()) {
    const std::string cell = Cell(table, row, measure.column);
    cells +=
        fmt::format(R"(<td class="number" data-value="{}">{}</td>)", HtmlEscape(cell), FormatMeasure(measure, cell));
  }
  return cells;
}

/// The error of a failed run in place of its numbers; it sorts like empty cells.
std::string FailureCell(const CsvTable& table, std::size_t row) {
  return fmt::format(R"(<td class="wrap failed" data-value="" colspan="{}">{}</td>)", 1 + RunMeasures().size(),
                     HtmlEscape(Cell(table, row, "failure")));
}

/// A row for each run and alignment with the main measures.
std::string ShortTable(const std::vector<RunFolder>& runs, const CsvTable& table) {
  std::ostringstream out;
  out << OpenTable("Errors, lifetimes and speed") << "<th scope=\"col\">Run</th><th scope=\"col\">Status</th>"
      << "<th scope=\"col\">Alignment</th>";
  for (const auto& measure : RunMeasures()) {
    out << "<th scope=\"col\" class=\"number\">" << measure.heading << "<span class=\"unit\"> " << measure.unit
        << "</span></th>";
  }
  out << "</tr></thead>\n<tbody>\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const bool failed = Cell(table, i, "status") == "failed";
    out << "<tr><th scope=\"row\">" << RunLink(runs, Cell(table, i, "run")) << "</th>"
        << (failed ? "<td class=\"failed\">failed</td>" + FailureCell(table, i)
                   : "<td>ok</td>" + MeasureCells(table, i))
        << "</tr>\n";
  }
  out << kCloseTable;
  return out.str();
}

/// All columns of runs.csv.
std::string WholeTable(const std::vector<RunFolder>& runs, const CsvTable& table) {
  std::ostringstream out;
  out << "<details class=\"columns\">\n<summary>All " << table.columns.size() << " columns</summary>\n"
      << OpenTable("All columns");
  for (const auto& column : table.columns) out << "<th scope=\"col\">" << HtmlEscape(column) << "</th>";
  out << "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    out << "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k) {
      const bool name = table.columns[k] == "run";
      out << (ParseMeasure(row[k]) ? "<td class=\"number\">" : "<td>")
          << (name ? RunLink(runs, row[k]) : HtmlEscape(row[k])) << "</td>";
    }
    out << "</tr>\n";
  }
  out << kCloseTable << "</details>\n";
  return out.str();
}

std::string ParameterTable(const std::vector<RunFolder>& runs) {
  const auto differences = CompareParameters(runs);
  if (differences.empty()) return "<p>All runs have the same parameters.</p>\n";
  std::ostringstream out;
  out << OpenTable("Parameters that differ") << "<th scope=\"col\">Parameter</th>";
  for (const auto& run : runs) out << "<th scope=\"col\">" << HtmlEscape(run.name) << "</th>";
  out << "</tr></thead>\n<tbody>\n";
  for (const auto& [name, values] : differences) {
    out << "<tr><th scope=\"row\">" << HtmlEscape(name) << "</th>";
    for (const auto& value : values) out << "<td>" << HtmlEscape(value) << "</td>";
    out << "</tr>\n";
  }
  out << kCloseTable;
  return out.str();
}

/// A word of a command line, quoted for a shell where needed.
std::string ShellWord(const std::string& word) {
  const bool plain = !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
    return std::isalnum(c) || std::string_view("_-+=./:,@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  quoted += '\'';
  return quoted;
}

std::string CommandAndInputs(const Manifest& manifest) {
  std::ostringstream out;
  std::string command;
  for (const auto& word : manifest.command_line) command.append(command.empty() ? "" : " ").append(ShellWord(word));
  out << "<h3>Command line (evo-run " << HtmlEscape(manifest.version) << ")</h3>\n<pre>" << HtmlEscape(command)
      << "</pre>\n<h3>Inputs</h3>\n<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"Inputs\">\n"
      << "<table>\n<thead><tr><th scope=\"col\">Role</th><th scope=\"col\">File</th>"
      << "<th scope=\"col\" class=\"number\">Bytes</th><th scope=\"col\">SHA-256</th></tr></thead>\n<tbody>\n";
  for (const auto& input : manifest.inputs) {
    out << "<tr><td>" << HtmlEscape(input.role) << "</td><td>" << HtmlEscape(input.path.string())
        << "</td><td class=\"number\">" << input.bytes << "</td><td><code>" << HtmlEscape(input.sha256)
        << "</code></td></tr>\n";
  }
  out << kCloseTable;
  return out.str();
}

std::string Warnings(const RunFolder& run) {
  std::string text;
  for (const auto& warning : run.warnings) text += HtmlEscape(warning) + "\n";
  if (run.manifest) {
    for (const TimeNs stamp : run.manifest->rebootstraps)
      text += fmt::format("odometry reinitialised at {} s\n", FormatTime(stamp));
  }
  return text.empty() ? "" : "<h3>Warnings</h3>\n<pre>" + text + "</pre>\n";
}

std::string RunDetails(const RunFolder& run, std::size_t number, const std::string& parameters) {
  std::ostringstream out;
  out << "<details class=\"run\" id=\"run-" << number << "\">\n<summary>" << HtmlEscape(run.name)
      << (run.failure.empty() ? "" : " <span class=\"failed\">failed</span>") << "</summary>\n<div>\n";
  if (!run.failure.empty()) out << "<p class=\"failed\">" << HtmlEscape(run.failure) << "</p>\n";
  out << Pictures(run, number);
  if (!parameters.empty()) {
    out << "<h3>Parameters that differ between the runs</h3>\n<pre>" << HtmlEscape(parameters) << "</pre>\n";
  }
  out << Warnings(run);
  if (run.manifest) out << CommandAndInputs(*run.manifest);
  out << "</div>\n</details>\n";
  return out.str();
}

/// The differing parameters of a run.
std::string Parameters(const CsvTable& table, const std::string& run) {
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (Cell(table, i, "run") == run) return Cell(table, i, "parameters");
  }
  return "";
}

}  // namespace

std::string RunsPage(const std::string& title, const std::vector<RunFolder>& runs, const CsvTable& table) {
  const auto failed =
      static_cast<std::size_t>(std::ranges::count_if(runs, [](const RunFolder& run) { return !run.failure.empty(); }));
  std::ostringstream body;
  body << "<h1>" << HtmlEscape(title) << "</h1>\n<p class=\"lead\">" << Plural(runs.size(), "run") << ", "
       << (failed == 0 ? "none" : std::to_string(failed)) << " failed</p>\n"
       << FailureList(runs) << DiagnosisSection(runs) << "<h2>Results</h2>\n"
       << "<p class=\"note\">Position errors are mean absolute errors after alignment, in m and in % of the path "
          "length; "
          "&ldquo;max&rdquo; is the largest one. APE RMSE is the root mean square absolute pose error (translation). "
          "Lifetime is the mean over the feature tracks.</p>\n"
       << ShortTable(runs, table) << WholeTable(runs, table) << Thumbnails(runs) << "<h2>Parameters</h2>\n"
       << ParameterTable(runs) << "<h2>Runs</h2>\n";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    body << RunDetails(runs[i], i + 1, Parameters(table, runs[i].name));
  }
  return ExpandTemplate(
      kPageTemplate,
      {{"title", HtmlEscape(title)}, {"style", kPageStyle}, {"script", kPageScript}, {"body", body.str()}});
}

}  // namespace evo::report
