#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/io/trajectory_io.hpp"

namespace evo::app {

/// The options that the subcommands share.
struct CommonOptions {
  std::string config_file;  ///< empty: none
  std::vector<std::string> settings;
  int threads = 0;  ///< 0: one per processor
  bool force = false;
  std::string ground_truth_source = "loam";
  int verbose = 0;
  bool quiet = false;

  /// Starts the log and sets the parameters from the file and then from the settings. Throws Error.
  void Apply(Parameters* parameters) const;
  io::GroundTruthSource Source() const;
};

/// The output folder and the figures of a run.
struct ResultOptions {
  std::filesystem::path out;
  bool no_plots = false;
  double draw_every_s = 0.0;  ///< 0: event frames are drawn once, in the middle, unless no_plots
};

/// A number in [min, max]; NaN is refused.
CLI::Validator NumberBetween(double min, double max);

/// --config, --set, -v and -q.
void AddConfigurationOptions(CLI::App& command, CommonOptions& options);
/// --set, -v and -q.
void AddSettingOptions(CLI::App& command, CommonOptions& options);
/// --threads and --force.
void AddComputeOptions(CLI::App& command, CommonOptions& options);
/// --ground-truth-source.
void AddGroundTruthSourceOption(CLI::App& command, CommonOptions& options);
/// --align.
void AddAlignmentOption(CLI::App& command, std::string& align);
/// --out, which is required.
void AddOutOption(CLI::App& command, ResultOptions& options);
/// --no-plots.
void AddPlotOption(CLI::App& command, ResultOptions& options);
/// --draw-every.
void AddDrawingOption(CLI::App& command, ResultOptions& options);

}  // namespace evo::app
