#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "evo/core/error.hpp"
#include "evo/report/evaluation_tables.hpp"
#include "evo/report/manifest.hpp"
#include "evo/report/run_table.hpp"
#include "report/fixtures.hpp"

namespace evo::report {

/// Makes the output folders of runs.
class RunsTest : public ReportTest {
 protected:
  using Parameters = std::vector<std::pair<std::string, std::string>>;

  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }

  /// 10 s recorded, 4 s computed.
  void WriteRunManifest(const std::string& name, const Parameters& parameters) const {
    Manifest manifest;
    manifest.version = "1.0";
    manifest.command_line = {"evo-run", "run", "it's"};
    manifest.parameters = parameters;
    manifest.inputs = {{"events", "e.hdf5", 12, "abc"}};
    manifest.counts = {{"threads", 2}, {"events", 7}};
    manifest.stages = {{"track", 3.0}, {"odometry", 1.0}};
    manifest.rebootstraps = {1'500'000'000};
    manifest.recorded_s = 10.0;
    WriteManifest(folder / name / "manifest.json", manifest);
  }

  std::filesystem::path EvaluatedRun(const std::string& name, const Parameters& parameters = {},
                                     const std::string& summary = "") const {
    WriteRunManifest(name, parameters);
    Write(name + "/summary.csv", summary.empty() ? "sequence,alignment,coverage,mean_planar_m\n"
                                                   "day,origin-scale,0.9,1.25\nday,sim3,0.9,0.5\n"
                                                 : summary);
    return folder / name;
  }

  std::filesystem::path FailedRun(const std::string& name, const std::string& why) const {
    return Write(name + "/failure.txt", why).parent_path();
  }

  std::filesystem::path TrackedRun(const std::string& name) const {
    WriteRunManifest(name, {});
    evaluation::LifetimeStatistics statistics;
    statistics.tracks = 2;
    statistics.in_frames = {4.0, 1.0, 4.0, 5.0};
    statistics.in_seconds = {0.1, 0.025, 0.1, 0.125};
    WriteLifetimes(folder / name / "lifetime.csv", statistics);
    return folder / name;
  }

  static std::string Cell(const CsvTable& table, std::size_t row, const std::string& column) {
    const auto found = table.Find(column);
    EXPECT_TRUE(found) << column;
    return found ? table.rows.at(row)[*found] : "";
  }

  static std::string Refusal(const std::vector<std::filesystem::path>& paths) {
    try {
      ReadRunFolders(paths);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      return error.what();
    }
    ADD_FAILURE() << "accepted";
    return "";
  }
};

}  // namespace evo::report
