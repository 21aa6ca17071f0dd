#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace evo::app {

/// A subcommand: how it is called and what it does. To add one, write its AddXxxCommand in a file of its own and name
/// it in main.cpp.
struct Command {
  CLI::App* parser = nullptr;
  /// Called after parsing if the user chose this command; throws Error. The words of the command line are for the
  /// manifest.
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
