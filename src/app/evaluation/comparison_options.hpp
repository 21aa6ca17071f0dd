#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "evo/evaluation/evaluation.hpp"

namespace evo::app {

/// The arguments of `evaluate` that win over the parameters of the same meaning; empty ones were not given.
struct ComparisonArguments {
  std::string association;
  std::optional<double> max_difference_s;
  std::optional<double> time_offset_s;
  std::string rpe;
  std::string rpe_pairs;
  std::string project;
  std::string up;
  std::string forward;

  /// Whether one of them concerns stamps, which KITTI poses lack.
  bool concern_stamps() const { return !association.empty() || max_difference_s || time_offset_s; }
  /// Copies the given arguments into `options`. Throws Error (kUsage).
  void Apply(evaluation::EvaluationOptions* options) const;
};

/// --association, --max-difference, --time-offset, --rpe, --rpe-pairs, --project, --up and --forward.
void AddComparisonOptions(CLI::App& command, ComparisonArguments& arguments);

/// The stamps of --from-stamp and --to-stamp; empty ones were not given.
struct IntervalArguments {
  std::string from;
  std::string to;

  /// Throws Error (kUsage).
  evaluation::EvaluationInterval Parse() const;
};

/// --from-stamp and --to-stamp.
void AddIntervalOptions(CLI::App& command, IntervalArguments& arguments);

}  // namespace evo::app
