#pragma once

#include <string>

#include "evo/evaluation/evaluation.hpp"
#include "evo/evaluation/lifetime.hpp"

namespace evo::report {

// Tables in the layout of D. Zhu's paper, for \input in a document that loads booktabs. Names are escaped. An
// undetermined value is a dash.

/// Table 2 of the paper: mean and standard deviation of the track lifetimes, in frames and in seconds.
std::string LifetimeTable(const std::string& sequence, const evaluation::LifetimeStatistics& statistics);

/// Table 3 of the paper, one block for each alignment. "Average error" is the mean absolute error and "relative error"
/// the largest absolute error over the path length, the definitions that the paper's numbers fit. The rows below are
/// other readings of these words under explicit names.
std::string ErrorTable(const std::string& sequence, const evaluation::Evaluation& evaluation);

}  // namespace evo::report
