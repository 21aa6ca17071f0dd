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

/// Collects the manifest of a run.
class RunRecord {
 public:
  RunRecord(const std::vector<std::string>& command_line, const Parameters& parameters);
  ~RunRecord();

  /// Adds an input with its checksum. Throws Error (kInput).
  void AddInput(const std::string& role, const std::filesystem::path& path);
  /// Adds an input and computes its checksum during the run: recordings have tens of gigabytes.
  void AddLargeInput(const std::string& role, const std::filesystem::path& path);
  /// Waits for these checksums and adds them to the manifest. Throws Error (kInput).
  void FinishChecksums();
  void AddCount(const std::string& name, std::size_t count);
  /// Calls `work`, records its wall time under `stage` and returns its result.
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
    std::size_t input;  // index in manifest.inputs
    std::future<std::string> sha256;
  };

  std::stop_source stop_;  // a run that fails does not wait for its checksums
  std::vector<Checksum> checksums_;
};

}  // namespace evo::app
