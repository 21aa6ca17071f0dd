#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "evo/report/run_folder.hpp"

namespace evo::report {

// Pictures on the page of runs. Pictures of more than 2 MB are named instead of shown. `number` is the number of a run,
// from 1. Functions throw Error (kInput) if a picture cannot be read.

/// A link to the details of a run, "#run-NUMBER".
std::string RunLink(const RunFolder& run, std::size_t number);

/// Trajectories and errors of all runs, small and side by side; empty if there are none.
std::string Thumbnails(const std::vector<RunFolder>& runs);

/// All plots and event frames of a run. Pictures of Thumbnails are referred to, not embedded again.
std::string Pictures(const RunFolder& run, std::size_t number);

}  // namespace evo::report
