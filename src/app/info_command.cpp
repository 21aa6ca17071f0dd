#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "evo/io/describe.hpp"

namespace evo::app {

namespace {

void RunInfo(const std::string& path) {
  const io::Description description = io::Describe(path);
  std::size_t width = 0;
  for (const auto& [name, value] : description.values) width = std::max(width, name.size());
  std::cout << path << ": " << description.kind << '\n';
  for (const auto& [name, value] : description.values) {
    std::cout << "  " << std::left << std::setw(static_cast<int>(width)) << name << "  " << value << '\n';
  }
}

}  // namespace

Command AddInfoCommand(CLI::App& app) {
  auto path = std::make_shared<std::string>();
  auto* const parser = app.add_subcommand("info", "Say what a file holds");
  parser->add_option("FILE", *path, "events, trajectory, ground truth, tracks, calibration, or a sequence's folder")
      ->required()
      ->type_name("");
  parser->footer("Example:\n  evo-run info outdoor_day2_data.hdf5");
  return {parser, [path](const auto&) { RunInfo(*path); }};
}

}  // namespace evo::app
