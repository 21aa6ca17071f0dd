#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "app/recording.hpp"
#include "evo/core/error.hpp"
#include "evo/io/file_description.hpp"

namespace evo::app {

namespace {

void RunInfo(const std::string& path, const std::string& mask_path) {
  std::optional<io::Mask> mask;
  if (IsAutoMask(mask_path)) {
    throw Error(ErrorKind::kUsage,
                "--mask auto needs a calibrated sensor, which info does not ask for; find the mask with "
                "evo-run track --mask auto --save-mask FILE and give the file");
  }
  if (!mask_path.empty()) mask = io::ReadMask(mask_path);
  const io::FileDescription description = io::DescribeFile(path, mask ? &*mask : nullptr);
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
  auto mask = std::make_shared<std::string>();
  auto* const parser = app.add_subcommand("info", "Describe a file: its kind, size and extent");
  parser->add_option("FILE", *path, "Events, trajectory, ground truth, tracks, calibration or the folder of a sequence")
      ->required()
      ->type_name("");
  AddMaskOption(*parser, *mask, "PNG of the sensor's size; events at its black or transparent pixels are ignored");
  parser->footer(
      "Examples:\n"
      "  evo-run info data_samples/street\n"
      "  evo-run info outdoor_day2_data.hdf5\n"
      "  evo-run info out/tracks.txt");
  return {parser, [path, mask](const auto&) { RunInfo(*path, *mask); }};
}

}  // namespace evo::app
