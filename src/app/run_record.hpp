#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/report/manifest.hpp"

namespace evo::app {

/// Collects a run's manifest as the run goes on.
class RunRecord {
 public:
  RunRecord(const std::vector<std::string>& command_line, const Parameters& parameters);

  /// Reads the file for its checksum. Throws Error (kInput).
  void AddInput(const std::string& role, const std::filesystem::path& path);
  void AddCount(const std::string& name, std::size_t count);
  /// Calls `work`, notes its wall time under `stage` and returns what it returns.
  template <typename Work>
  auto Time(const std::string& stage, const Work& work) {
    const Stopwatch stopwatch{manifest.stages, stage};
    return work();
  }

  Manifest manifest;

 private:
  struct Stopwatch {
    std::vector<StageTime>& stages;
    std::string stage;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    ~Stopwatch();
  };
};

}  // namespace evo::app
