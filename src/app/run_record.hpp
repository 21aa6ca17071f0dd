#pragma once

#include <chrono>
#include <filesystem>
#include <future>
#include <stop_token>
#include <string>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/report/manifest.hpp"

namespace evo::app {

/// Collects a run's manifest as the run goes on.
class RunRecord {
 public:
  RunRecord(const std::vector<std::string>& command_line, const Parameters& parameters);
  ~RunRecord();

  /// Reads the file for its checksum. Throws Error (kInput).
  void AddInput(const std::string& role, const std::filesystem::path& path);
  /// Reads the file for its checksum while the run goes on: recordings are tens of gigabytes.
  void AddLargeInput(const std::string& role, const std::filesystem::path& path);
  /// Waits for the checksums, which the manifest does not hold before. Throws Error (kInput).
  void FinishChecksums();
  void AddCount(const std::string& name, std::size_t count);
  /// Calls `work`, notes its wall time under `stage` and returns what it returns.
  template <typename Work>
  auto Time(const std::string& stage, const Work& work) {
    const Stopwatch stopwatch{manifest.stages, stage};
    return work();
  }

  report::Manifest manifest;

 private:
  struct Stopwatch {
    std::vector<report::StageTime>& stages;
    std::string stage;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    ~Stopwatch();
  };
  struct Checksum {
    std::size_t input;  // index in the manifest
    std::future<std::string> sha256;
  };

  std::stop_source stop_;  // a run that fails does not wait for its checksums
  std::vector<Checksum> checksums_;
};

}  // namespace evo::app
