#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/io/trajectory_io.hpp"

namespace evo::app {

/// What every subcommand understands.
struct CommonOptions {
  std::string config_file;  ///< empty if none
  std::vector<std::string> settings;
  int threads = 0;  ///< 0: one for each processor
  bool force = false;
  std::string ground_truth_source = "loam";
  int verbose = 0;
  bool quiet = false;

  /// Starts the log and reads the configuration: defaults, then the file, then the settings.
  void Apply(Parameters* parameters) const;
  io::GroundTruthSource Source() const;
};

/// A number in [lowest, highest]; NaN never is.
CLI::Validator NumberBetween(double lowest, double highest);

/// --config, --set, -v and -q.
void AddConfigurationOptions(CLI::App& command, CommonOptions& options);
/// All of them but --config.
void AddSettingOptions(CLI::App& command, CommonOptions& options);
/// --threads and --force, for the commands that compute something.
void AddComputeOptions(CLI::App& command, CommonOptions& options);
/// --ground-truth-source and --align, for the commands that compare with the truth.
void AddGroundTruthSourceOption(CLI::App& command, CommonOptions& options);
void AddAlignmentOption(CLI::App& command, std::string& align);

}  // namespace evo::app
