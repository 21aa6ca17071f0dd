#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evo/evaluation/evaluation.hpp"

namespace evo::app {

/// The files of WriteEvaluationResults without plots, relative to the output folder: summary.csv, summary.json,
/// metrics.csv, tables/errors.tex, errors.csv for the first alignment and errors_NAME.csv for each further one
/// ("first:5" becomes first-5).
std::vector<std::string> EvaluationResultNames(std::span<const evaluation::Alignment> alignments);

/// Removes these files for all alignments, their plots, and manifest.json, which lists them, from `folder`.
void RemoveEvaluationResults(const std::filesystem::path& folder);

/// Stamps of the estimate at which the odometry reinitialised; empty if they are not known.
using Restarts = std::optional<std::vector<TimeNs>>;

/// Logs missing alignments and relative errors and writes the files, with the plots trajectory, axes, errors,
/// errors_distance and scale_drift (_NAME) as SVG and PDF if `with_plots`. Without any alignment it writes nothing.
void WriteEvaluationResults(const std::filesystem::path& folder, const std::string& sequence,
                            const evaluation::Evaluation& evaluation, bool with_plots,
                            const Restarts& restarts = std::nullopt);

}  // namespace evo::app
