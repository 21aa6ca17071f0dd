#include "app/options.hpp"

#include <fmt/format.h>

#include "evo/core/logging.hpp"

namespace evo::app {

void CommonOptions::Apply(Parameters* parameters) const {
  SetUpLogging(quiet ? -1 : verbose);
  if (!config_file.empty()) parameters->LoadFile(config_file);
  for (const auto& setting : settings) parameters->Set(setting);
}

io::GroundTruthSource CommonOptions::Source() const {
  return ground_truth_source == "loam" ? io::GroundTruthSource::kLoam : io::GroundTruthSource::kCartographer;
}

CLI::Validator NumberBetween(double min, double max) {
  const auto check = [=](const std::string& text) -> std::string {
    double number = 0.0;
    if (CLI::detail::lexical_cast(text, number) && number >= min && number <= max) return "";
    return fmt::format("'{}' is not a number from {:g} to {:g}", text, min, max);
  };
  return {check, ""};
}

void AddConfigurationOptions(CLI::App& command, CommonOptions& options) {
  command
      .add_option("--config", options.config_file,
                  "YAML file of parameters, as 'evo-run config --print' writes it; default: the built-in values")
      ->type_name("FILE");
  AddSettingOptions(command, options);
}

void AddSettingOptions(CLI::App& command, CommonOptions& options) {
  command.add_option("--set", options.settings, "Value of one parameter, which overrides the file; may be repeated")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  auto* const verbose = command.add_flag("-v,--verbose", options.verbose, "Print debug messages on stderr");
  command.add_flag("-q,--quiet", options.quiet, "Print only errors on stderr")->excludes(verbose);
}

void AddComputeOptions(CLI::App& command, CommonOptions& options) {
  command.add_option("--threads", options.threads, "Number of threads, at most 1024; default: one per processor")
      ->check(CLI::Range(0, 1024).description(""))
      ->type_name("N");
  command.add_flag("--force", options.force, "Overwrite earlier results in the --out folder");
}

void AddGroundTruthSourceOption(CLI::App& command, CommonOptions& options) {
  command
      .add_option("--ground-truth-source", options.ground_truth_source,
                  "Trajectory of an MVSEC _gt.hdf5: loam is davis/left/odometry, cartographer is davis/left/pose")
      ->check(CLI::IsMember({"loam", "cartographer"}).description(""))
      ->capture_default_str()
      ->type_name("loam|cartographer");
}

void AddAlignmentOption(CLI::App& command, std::string& align) {
  command
      .add_option("--align", align,
                  "Alignments of the estimate with the truth, separated by commas: none, origin (first pose), "
                  "origin-scale (first pose and scale), scale, posyaw (position and yaw), se3, sim3; the last five may "
                  "be fitted to the first poses or seconds alone, such as se3:100 or sim3:5s")
      ->capture_default_str()
      ->type_name("LIST");
}

void AddOutOption(CLI::App& command, ResultOptions& options) {
  command.add_option("--out", options.out, "Folder for the results, created if it does not exist")
      ->required()
      ->type_name("DIR");
}

void AddPlotOption(CLI::App& command, ResultOptions& options) {
  command.add_flag("--no-plots", options.no_plots, "Write tables only");
}

void AddDrawingOption(CLI::App& command, ResultOptions& options) {
  command
      .add_option(
          "--draw-every", options.draw_every_s,
          "Interval in s at which four event frames with their tracks are drawn into images/; default: once, in "
          "the middle")
      ->check(NumberBetween(1e-3, 1e6))
      ->type_name("S");
}

}  // namespace evo::app
