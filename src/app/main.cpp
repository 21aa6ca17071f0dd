#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "evo/core/error.hpp"

namespace {

constexpr int kUnexpectedError = 1;  // exit code

/// Prints one line, whatever the message holds.
int Fail(std::string message, int exit_code) {
  while (message.ends_with('\n')) message.pop_back();
  for (char& c : message) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  std::fprintf(stderr, "evo-run: error: %s\n", message.c_str());
  return exit_code;
}

/// The help of the chosen command, or the overview.
std::string HelpCommand(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? "evo-run --help" : "evo-run " + chosen.front()->get_name() + " --help";
}

int Run(int argc, char** argv) {
  CLI::App app("Visual odometry from an event camera alone: events in, trajectory out.", "evo-run");
  app.set_version_flag("--version", "evo-run " EVO_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  evo-run run --events data_samples/street --out out/street\n"
      "  evo-run simulate configs/scenes/driving_day.yaml --from 50 --duration 8 --out out/driving_day\n"
      "  evo-run COMMAND --help    options and examples of a command");
  const std::vector<evo::app::Command> commands{evo::app::AddRunCommand(app),      evo::app::AddTrackCommand(app),
                                                evo::app::AddOdometryCommand(app), evo::app::AddEvaluateCommand(app),
                                                evo::app::AddReportCommand(app),   evo::app::AddSimulateCommand(app),
                                                evo::app::AddInfoCommand(app),     evo::app::AddConfigCommand(app)};
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return Fail(std::string(error.what()) + "; see " + HelpCommand(app), static_cast<int>(evo::ErrorKind::kUsage));
  }
  for (const auto& command : commands) {
    if (command.parser->parsed()) command.run(std::vector<std::string>(argv, argv + argc));
  }
  std::cout.flush();
  if (!std::cout) throw evo::Error(evo::ErrorKind::kOutput, "standard output: writing failed; is the disk full?");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return Run(argc, argv);
  } catch (const evo::Error& error) {
    return Fail(error.what(), error.exit_code());
  } catch (const std::exception& error) {
    return Fail(std::string("unexpected: ") + error.what(), kUnexpectedError);
  }
}
