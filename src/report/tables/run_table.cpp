#include "evo/report/run_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "evo/core/error.hpp"

namespace evo::report {

namespace {

using Cells = std::vector<std::pair<std::string, std::string>>;

std::string Number(double value) { return fmt::format("{:.9g}", value); }

/// Parameters of a run that differ between the runs, as NAME=VALUE.
std::string DifferingParameters(const std::vector<ParameterDifference>& differences, std::size_t run) {
  std::string text;
  for (const auto& [name, values] : differences) {
    if (!values[run].empty()) text += (text.empty() ? "" : " ") + name + "=" + values[run];
  }
  return text;
}

/// Cells about the cost of a run.
Cells CostCells(const Manifest& manifest) {
  Cells cells;
  if (manifest.recorded_s) cells.emplace_back("recorded_s", Number(*manifest.recorded_s));
  if (const auto factor = RealTimeFactor(manifest)) cells.emplace_back("speed_x_real_time", Number(*factor));
  for (const auto& [name, count] : manifest.counts) {
    if (name == "threads") cells.emplace_back(name, std::to_string(count));
  }
  for (const auto& [stage, seconds] : manifest.stages) cells.emplace_back("wall_" + stage + "_s", Number(seconds));
  return cells;
}

/// Collects rows with different columns.
class TableBuilder {
 public:
  void DeclareColumns(const std::vector<std::string>& names) {
    for (const auto& name : names) Column(name);
  }

  void AddRow(const Cells& cells) {
    auto& row = table_.rows.emplace_back();
    for (const auto& [name, value] : cells) {
      const std::size_t column = Column(name);
      row.resize(std::max(row.size(), column + 1));
      row[column] = value;
    }
  }

  CsvTable Finish() {
    for (auto& row : table_.rows) row.resize(table_.columns.size());
    return std::move(table_);
  }

 private:
  std::size_t Column(const std::string& name) {
    if (const auto found = table_.Find(name)) return *found;
    table_.columns.push_back(name);
    return table_.columns.size() - 1;
  }

  CsvTable table_;
};

}  // namespace

CsvTable MergeRuns(const std::vector<RunFolder>& runs) {
  const auto differences = CompareParameters(runs);
  TableBuilder table;
  table.DeclareColumns({"run", "status", "failure"});
  for (const auto& run : runs) {
    if (run.summary) table.DeclareColumns(run.summary->columns);
  }
  table.DeclareColumns({"lifetime_mean_frames", "lifetime_std_frames", "lifetime_mean_s", "lifetime_std_s",
                        "lifetime_tracks", "recorded_s", "speed_x_real_time", "threads"});
  for (const auto& run : runs) {
    if (!run.manifest) continue;
    for (const auto& cell : CostCells(*run.manifest)) table.DeclareColumns({cell.first});
  }
  table.DeclareColumns({"parameters"});
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunFolder& run = runs[i];
    Cells common{{"run", run.name}, {"status", run.failure.empty() ? "ok" : "failed"}, {"failure", run.failure}};
    common.insert(common.end(), run.lifetimes.begin(), run.lifetimes.end());
    const Cells cost = run.manifest ? CostCells(*run.manifest) : Cells{};
    common.insert(common.end(), cost.begin(), cost.end());
    common.emplace_back("parameters", DifferingParameters(differences, i));
    if (!run.summary) table.AddRow(common);
    for (std::size_t k = 0; run.summary && k < run.summary->rows.size(); ++k) {
      Cells cells;
      for (std::size_t c = 0; c < run.summary->columns.size(); ++c) {
        cells.emplace_back(run.summary->columns[c], run.summary->rows[k][c]);
      }
      cells.insert(cells.end(), common.begin(), common.end());
      table.AddRow(cells);
    }
  }
  return table.Finish();
}

std::vector<ParameterDifference> CompareParameters(const std::vector<RunFolder>& runs) {
  std::vector<ParameterDifference> parameters;
  std::vector<std::size_t> described;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!runs[i].manifest) continue;
    described.push_back(i);
    for (const auto& [name, value] : runs[i].manifest->parameters) {
      auto entry = std::ranges::find(parameters, name, &ParameterDifference::name);
      if (entry == parameters.end()) {
        entry = parameters.insert(parameters.end(), {name, std::vector<std::string>(runs.size())});
      }
      entry->values[i] = value;
    }
  }
  std::erase_if(parameters, [&](const ParameterDifference& parameter) {
    return std::ranges::all_of(
        described, [&](std::size_t i) { return parameter.values[i] == parameter.values[described.front()]; });
  });
  return parameters;
}

std::string ChooseAlignment(const std::vector<RunFolder>& runs, const std::string& wanted) {
  std::vector<std::vector<std::string>> offered;
  for (const auto& run : runs) {
    if (!run.summary) continue;
    auto& names = offered.emplace_back();
    for (const auto& row : run.summary->rows) names.push_back(row[*run.summary->Find("alignment")]);
  }
  const auto has = [](const std::string& name) {
    return [&name](const std::vector<std::string>& names) { return std::ranges::find(names, name) != names.end(); };
  };
  if (!wanted.empty()) {
    if (std::ranges::any_of(offered, has(wanted))) return wanted;
    std::string known;
    for (const auto& name : offered.empty() ? std::vector<std::string>{} : offered.front()) known += " " + name;
    throw Error(ErrorKind::kUsage, fmt::format("--alignment: no run has '{}'; {}", wanted,
                                               known.empty() ? "none was evaluated" : "the first one has" + known));
  }
  if (offered.empty()) return "";
  for (const auto& name : offered.front()) {
    if (std::ranges::all_of(offered, has(name))) return name;
  }
  return offered.front().front();
}

}  // namespace evo::report
