#include "app/options.hpp"

#include "evo/core/format.hpp"
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

CLI::Validator NumberBetween(double lowest, double highest) {
  const auto check = [=](const std::string& text) -> std::string {
    double number = 0.0;
    if (CLI::detail::lexical_cast(text, number) && number >= lowest && number <= highest) return "";
    return "'" + text + Format("' is not a number from %g to %g", lowest, highest);
  };
  return {check, ""};
}

void AddConfigurationOptions(CLI::App& command, CommonOptions& options) {
  command.add_option("--config", options.config_file, "YAML file of parameters; see 'evo-run config --print'")
      ->type_name("FILE");
  AddSettingOptions(command, options);
}

void AddSettingOptions(CLI::App& command, CommonOptions& options) {
  command.add_option("--set", options.settings, "one parameter, may be repeated; wins over the file")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  auto* const verbose = command.add_flag("-v,--verbose", options.verbose, "say more on stderr");
  command.add_flag("-q,--quiet", options.quiet, "say nothing on stderr but errors")->excludes(verbose);
}

void AddComputeOptions(CLI::App& command, CommonOptions& options) {
  command.add_option("--threads", options.threads, "threads to use, up to 1024; default: one for each processor")
      ->check(CLI::Range(0, 1024).description(""))
      ->type_name("N");
  command.add_flag("--force", options.force, "overwrite earlier results in the --out folder");
}

void AddGroundTruthSourceOption(CLI::App& command, CommonOptions& options) {
  command
      .add_option("--ground-truth-source", options.ground_truth_source,
                  "trajectory of an MVSEC _gt.hdf5: loam is davis/left/odometry, cartographer davis/left/pose")
      ->check(CLI::IsMember({"loam", "cartographer"}).description(""))
      ->capture_default_str()
      ->type_name("loam|cartographer");
}

void AddAlignmentOption(CLI::App& command, std::string& align) {
  command
      .add_option("--align", align,
                  "comma-separated alignments: none, origin (first pose), origin-scale (and one scale), scale (alone), "
                  "posyaw (position and heading), se3, sim3; the last five also on a beginning: se3:100 (poses), "
                  "sim3:5s")
      ->capture_default_str()
      ->type_name("LIST");
}

}  // namespace evo::app
