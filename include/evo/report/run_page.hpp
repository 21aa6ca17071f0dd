#pragma once

#include <string>
#include <vector>

#include "evo/report/csv.hpp"
#include "evo/report/run_folder.hpp"

namespace evo::report {

/// index.html: one page about all runs that needs nothing but itself: a sortable table, each run's trajectory and
/// errors side by side, the parameters that differ, and for each run its plots, inputs, command line and warnings.
/// `table` is what MergeRuns returns for `runs`. Pictures of more than 2 MB are named instead of shown. The same runs
/// give the same bytes. Throws Error (kInput) if a plot cannot be read.
std::string RunsPage(const std::string& title, const std::vector<RunFolder>& runs, const CsvTable& table);

}  // namespace evo::report
