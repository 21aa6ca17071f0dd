#pragma once

#include <string>

#include "evo/evaluation/evaluation.hpp"
#include "evo/evaluation/lifetime.hpp"
#include "evo/evaluation/track_accuracy.hpp"

namespace evo::report {

// Summaries for the terminal: aligned lines that end with a newline. Scripts should read the CSV files instead.

std::string FormatSummary(const evaluation::Evaluation& evaluation);

std::string FormatTrackAccuracy(const evaluation::TrackAccuracy& accuracy);

/// One line; `note` is appended inside its parentheses.
std::string FormatLifetimes(const evaluation::LifetimeStatistics& statistics, const std::string& note = "");

}  // namespace evo::report
