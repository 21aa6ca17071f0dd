#pragma once

#include <string>
#include <utility>
#include <vector>

#include "evo/report/csv.hpp"
#include "evo/report/run_folder.hpp"

namespace evo::report {

/// runs.csv: a row for each run and alignment, one row for a run that has no summary. Columns: `run`, `status` ("ok" or
/// "failed") and `failure`; those of the runs' summary.csv in their order, new ones after the ones before; then
/// `lifetime_*` (mean and standard deviation in frames and s, number of tracks), `recorded_s`, `speed_x_real_time`
/// (see RealTimeFactor), `threads`, `wall_STAGE_s` and `parameters`, which are those that differ between the runs, as
/// NAME=VALUE with blanks between. A cell is empty where a run has no such value.
CsvTable MergeRuns(const std::vector<RunFolder>& runs);

/// A parameter that is not the same in all runs.
struct ParameterDifference {
  std::string name;
  std::vector<std::string> values;  ///< of each run; empty where the run has no manifest or does not know it
};

/// By name, in the order of the manifests. Runs without a manifest agree with every other.
std::vector<ParameterDifference> CompareParameters(const std::vector<RunFolder>& runs);

/// The alignment that a table with one row a run shows: `wanted`, or if that is empty the first one that all evaluated
/// runs have, else the first one of the first run; empty if no run was evaluated. Throws Error (kUsage) if no run has
/// `wanted`.
std::string ChooseAlignment(const std::vector<RunFolder>& runs, const std::string& wanted);

/// runs.tex: a booktabs table, a row for each run with its numbers under `alignment`, from what MergeRuns returns; a
/// run that failed or was not aligned so has a row that says it. Goes into a document that loads booktabs.
std::string RunsLatex(const CsvTable& runs, const std::string& alignment);

}  // namespace evo::report
