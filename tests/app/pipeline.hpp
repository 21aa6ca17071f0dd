#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "app/evo_run.hpp"

namespace evo::app {

inline std::vector<std::string> SplitAtCommas(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line + ',');  // the last cell may be empty
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

class PipelineTest : public EvoRunTest {
 protected:
  /// The row of `alignment` in summary.csv, by column.
  std::map<std::string, std::string> Summary(const std::string& result, const std::string& alignment) const {
    std::istringstream csv(ReadFile(folder / result / "summary.csv"));
    std::string line;
    std::getline(csv, line);
    const auto names = SplitAtCommas(line);
    std::map<std::string, std::string> row;
    while (std::getline(csv, line)) {
      const auto cells = SplitAtCommas(line);
      if (cells.size() != names.size() || cells[1] != alignment) continue;
      for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
    }
    return row;
  }

  double MeanLifetime(const std::string& result) const {
    const std::string csv = ReadFile(folder / result / "lifetime.csv");
    const std::string key = "\nmean,frames,,,";
    const auto found = csv.find(key);
    return found == std::string::npos ? 0.0 : std::stod(csv.substr(found + key.size()));
  }

  struct Bounds {
    double path_m = 0.0;
    double origin_scale_percent = 0.0;  ///< mean planar error
    double sim3_percent = 0.0;
    double lifetime_frames = 0.0;  ///< mean
  };

  /// Every frame has a pose, the map is never reinitialised, errors are below and lifetimes above the bounds.
  void ExpectQuality(const std::string& result, const Bounds& bounds) const {
    auto origin_scale = Summary(result, "origin-scale");
    auto sim3 = Summary(result, "sim3");
    ASSERT_FALSE(origin_scale.empty() || sim3.empty());
    EXPECT_EQ(origin_scale["rebootstraps"], "0");
    EXPECT_GE(std::stod(origin_scale["coverage"]), 0.99);
    EXPECT_NEAR(std::stod(origin_scale["path_m"]), bounds.path_m, 0.05 * bounds.path_m);
    EXPECT_LT(std::stod(origin_scale["mean_planar_percent"]), bounds.origin_scale_percent);
    EXPECT_LT(std::stod(sim3["mean_planar_percent"]), bounds.sim3_percent);
    EXPECT_GT(MeanLifetime(result), bounds.lifetime_frames);
  }

  /// The sorted names of the files in a folder.
  static std::vector<std::string> FileNames(const std::filesystem::path& directory) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(directory))
      names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
  }

  std::string Out(const std::string& result) const { return " --out " + Quote(folder / result); }

  /// Arguments for events and calibration without ground truth.
  static std::string WithoutTruth() {
    return "--events " + Quote(Sample("street_data.hdf5")) + " --calibration " +
           Quote(Sample("camchain-imucam-street.yaml")) + " --no-plots ";
  }

  void ExpectSameBytes(const std::string& a, const std::string& b, const std::vector<std::string>& names) const {
    for (const auto& name : names) {
      const std::string content = ReadFile(folder / a / name);
      EXPECT_FALSE(content.empty()) << name;
      EXPECT_TRUE(content == ReadFile(folder / b / name)) << name << " differs between " << a << " and " << b;
    }
  }
};

}  // namespace evo::app
