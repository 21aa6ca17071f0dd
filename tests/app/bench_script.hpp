#pragma once

#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/evo_run.hpp"

namespace evo::app {

/// A script of scripts/ that simulates, runs and judges, on a slider that is fast and short.
class BenchScriptTest : public EvoRunTest {
 protected:
  /// `script` as in bench_odometry: its file and the folder in out/ that its tables go to.
  explicit BenchScriptTest(std::string script) : script_(std::move(script)) {}

  void WriteScene(const std::string& name, const std::string& length_m = "0.3",
                  const std::string& duration_s = "0.3") const {
    Write(name + ".yaml",
          "scene:\n  kind: slider\n  calibration: davis240c\nmotion:\n  kind: slider\n  slider:\n    duration_s: " +
              duration_s + "\n    length_m: " + length_m + "\nsimulation:\n  samples: 1\n  image_hz: 0\n");
  }

  /// Runs the script in the test's folder and returns its exit code.
  int Bench(const std::string& words) {
    const std::string command = "cd " + Quote(folder) + " && EVO_RUN='" EVO_RUN "' bash " +
                                Quote(std::filesystem::path(EVO_SOURCE_DIR) / "scripts" / (script_ + ".sh")) + " " +
                                words + " >stdout 2>stderr";
    const int status = std::system(command.c_str());
    out = ReadFile(folder / "stdout");
    err = ReadFile(folder / "stderr");
    return WEXITSTATUS(status);
  }

  /// The same words again: nothing is done, and the same said.
  void ExpectNothingToDo(const std::string& words) {
    const std::string before = out;
    ASSERT_EQ(Bench(words), 0) << err;
    EXPECT_EQ(out, before);
    EXPECT_EQ(err, "") << "nothing to do";
  }

  bool Simulated() const { return err.find("simulate   ") != std::string::npos; }

  /// How often the program was run on a sequence.
  std::ptrdiff_t CountRuns() const {
    std::ptrdiff_t count = 0;
    for (std::size_t at = 0; (at = err.find("run        ", at)) != std::string::npos; ++at) ++count;
    return count;
  }

  /// A table in OUT, each row by the names of its columns.
  std::vector<std::map<std::string, std::string>> Table(const std::string& name) const {
    std::istringstream csv(ReadFile(folder / "out" / script_ / name));
    std::vector<std::string> header;
    std::vector<std::map<std::string, std::string>> rows;
    for (std::string line; std::getline(csv, line);) {
      std::istringstream stream(line + ',');
      std::vector<std::string> cells;
      for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
      if (header.empty()) {
        header = cells;
        continue;
      }
      EXPECT_EQ(cells.size(), header.size()) << line;
      rows.emplace_back();
      for (std::size_t i = 0; i < std::min(cells.size(), header.size()); ++i) rows.back()[header[i]] = cells[i];
    }
    return rows;
  }

 private:
  std::string script_;
};

}  // namespace evo::app
