#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "app/config.hpp"
#include "app/options.hpp"
#include "evo/core/error.hpp"

namespace evo::app {

namespace {

struct ConfigArguments {
  CommonOptions common;
  bool print = false;
  std::string check;
};

void RunConfig(const ConfigArguments& arguments) {
  if (arguments.print != arguments.check.empty()) {
    throw Error(ErrorKind::kUsage, "config: give either --print or --check FILE; see evo-run config --help");
  }
  Config config;
  arguments.common.Apply(&config.parameters);
  if (arguments.print) {
    std::cout << config.parameters.ToYaml();
  } else {
    config.parameters.LoadFile(arguments.check);
    std::cout << arguments.check << ": every parameter is known and in range\n";
  }
}

}  // namespace

Command AddConfigCommand(CLI::App& app) {
  auto arguments = std::make_shared<ConfigArguments>();
  auto* const parser = app.add_subcommand("config", "Print all parameters or check a configuration file");
  parser->add_flag("--print", arguments->print, "print every parameter with its value, range and meaning as YAML");
  parser->add_option("--check", arguments->check, "report the first mistake in a configuration file")
      ->type_name("FILE");
  AddConfigurationOptions(*parser, arguments->common);
  parser->footer("Example:\n  evo-run config --print > mine.yaml");
  return {parser, [arguments](const auto&) { RunConfig(*arguments); }};
}

}  // namespace evo::app
