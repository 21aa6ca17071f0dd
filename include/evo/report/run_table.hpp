#pragma once

#include <string>
#include <utility>
#include <vector>

#include "evo/report/csv.hpp"
#include "evo/report/run_folder.hpp"

namespace evo::report {

/// runs.csv: one row for each run and alignment, or one for a run without summary. Columns: `run`, `status` ("ok" or
/// "failed") and `failure`; the union of the columns of all summary.csv, in order of appearance; then `lifetime_*`
/// (mean and standard deviation in frames and s, number of tracks), `recorded_s`, `speed_x_real_time` (see
/// RealTimeFactor), `threads`, `wall_STAGE_s` and `parameters`, the parameters that differ between the runs as
/// NAME=VALUE separated by blanks. Missing values are empty cells.
CsvTable MergeRuns(const std::vector<RunFolder>& runs);

/// A parameter that differs between runs.
struct ParameterDifference {
  std::string name;
  std::vector<std::string> values;  ///< of each run; empty if the run has no manifest or no such parameter
};

/// Parameters that differ, in the order of the manifests. Runs without a manifest are ignored.
std::vector<ParameterDifference> CompareParameters(const std::vector<RunFolder>& runs);

/// The alignment for a table with one row a run: `wanted`; without it the first one that all evaluated runs have, or
/// else the first one of the first run; empty if no run was evaluated. Throws Error (kUsage) if no run has `wanted`.
std::string ChooseAlignment(const std::vector<RunFolder>& runs, const std::string& wanted);

/// runs.tex: a booktabs table with one row a run for `alignment`; `runs` is the table of MergeRuns. Runs that failed or
/// lack the alignment have a row that says so.
std::string RunsLatex(const CsvTable& runs, const std::string& alignment);

}  // namespace evo::report
