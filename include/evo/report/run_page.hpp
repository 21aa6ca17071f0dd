#pragma once

#include <string>
#include <vector>

#include "evo/report/csv.hpp"
#include "evo/report/run_folder.hpp"

namespace evo::report {

/// index.html: a self-contained page about all runs with what was seen in them, a sortable table, trajectories and
/// errors side by side, the parameters that differ, and for each run its plots, inputs, command line and warnings.
/// `table` is MergeRuns(runs). Pictures of more than 2 MB are named instead of shown. Equal runs give equal bytes.
/// Throws Error (kInput) if a picture cannot be read.
std::string RunsPage(const std::string& title, const std::vector<RunFolder>& runs, const CsvTable& table);

}  // namespace evo::report
