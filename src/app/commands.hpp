#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace evo::app {

/// A subcommand. To add one, write its AddXxxCommand in a file of commands/, declare it here and add it to main.cpp.
struct Command {
  CLI::App* parser = nullptr;
  /// Runs the command after parsing. `command_line` is for the manifest. Throws Error.
  std::function<void(const std::vector<std::string>& command_line)> run;
};

Command AddRunCommand(CLI::App& app);
Command AddTrackCommand(CLI::App& app);
Command AddOdometryCommand(CLI::App& app);
Command AddEvaluateCommand(CLI::App& app);
Command AddReportCommand(CLI::App& app);
Command AddSimulateCommand(CLI::App& app);
Command AddInfoCommand(CLI::App& app);
Command AddConfigCommand(CLI::App& app);

}  // namespace evo::app
