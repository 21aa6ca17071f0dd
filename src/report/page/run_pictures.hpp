#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "evo/report/run_folder.hpp"

namespace evo::report {

// The pictures on the page of many runs. Those of more than 2 MB are named instead of shown. `number` is that of a run
// among all, from 1. Both throw Error (kInput) if a picture cannot be read.

/// "#run-NUMBER" with the run's name.
std::string RunLink(const RunFolder& run, std::size_t number);

/// Trajectory and errors of each run, small and side by side; empty if there are none.
std::string Thumbnails(const std::vector<RunFolder>& runs);

/// All plots and sheets of a run. What Thumbnails holds is not embedded again but referred to.
std::string Pictures(const RunFolder& run, std::size_t number);

}  // namespace evo::report
