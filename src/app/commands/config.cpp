#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "app/config.hpp"
#include "app/options.hpp"
#include "app/simulation/scene_config.hpp"
#include "evo/core/error.hpp"

namespace evo::app {

namespace {

struct ConfigArguments {
  CommonOptions common;
  bool print = false;
  bool markdown = false;
  std::string check;
};

void PrintMarkdown(const Parameters& parameters) {
  std::cout
      << "# Parameters\n\n"
         "`evo-run config --markdown` writes this page. A parameter is given in a YAML file (`--config FILE`) or as "
         "`--set NAME=VALUE`.\n\n"
         "## Tracker, odometry and evaluation\n\n"
      << parameters.ToMarkdown() << "\n## Scenes of `evo-run simulate`\n\n"
      << SceneConfig().parameters.ToMarkdown();
}

void RunConfig(const ConfigArguments& arguments) {
  if (arguments.print + arguments.markdown + !arguments.check.empty() != 1) {
    throw Error(ErrorKind::kUsage,
                "config: give one of --print, --markdown and --check FILE; see evo-run config --help");
  }
  Config config;
  arguments.common.Apply(&config.parameters);
  if (arguments.print) {
    std::cout << config.parameters.ToYaml();
  } else if (arguments.markdown) {
    PrintMarkdown(config.parameters);
  } else {
    config.parameters.LoadFile(arguments.check);
    std::cout << arguments.check << ": every parameter is known and in range\n";
  }
}

}  // namespace

Command AddConfigCommand(CLI::App& app) {
  auto arguments = std::make_shared<ConfigArguments>();
  auto* const parser = app.add_subcommand("config", "Print all parameters or check a configuration file");
  parser->add_flag("--print", arguments->print, "Print every parameter with its value, range and meaning as YAML");
  parser->add_flag("--markdown", arguments->markdown,
                   "Print docs/parameters.md: a Markdown table of every parameter, those of scenes included");
  parser->add_option("--check", arguments->check, "Configuration file to check; the first mistake is reported")
      ->type_name("FILE");
  AddConfigurationOptions(*parser, arguments->common);
  parser->footer(
      "Examples:\n"
      "  evo-run config --print > mine.yaml\n"
      "  evo-run config --check mine.yaml\n"
      "  evo-run config --markdown > docs/parameters.md");
  return {parser, [arguments](const auto&) { RunConfig(*arguments); }};
}

}  // namespace evo::app
