#pragma once

#include <string>

#include "evo/evaluation/evaluation.hpp"
#include "evo/evaluation/lifetime.hpp"

namespace evo::report {

// Tables in the layout of the paper's, ready for \input in a document that uses the package booktabs. Names are
// escaped. A value that is not determined is a dash.

/// The paper's table 2: mean and standard deviation of the track lifetimes, here in frames and in seconds.
std::string LifetimeTable(const std::string& sequence, const evaluation::LifetimeStatistics& statistics);

/// The paper's table 3, a block for each alignment. Its "average error" is the mean of absolute values, its "relative
/// error" the largest absolute value over the length of the path: the definitions that the paper's numbers fit. The
/// rows below them are other readings of the same words, each named for what it is.
std::string ErrorTable(const std::string& sequence, const evaluation::Evaluation& evaluation);

}  // namespace evo::report
