#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/hot_pixels.hpp"
#include "evo/report/run_diagnosis.hpp"

namespace evo::report {

struct ManifestInput {
  std::string role;  ///< "events", "calibration", "ground_truth", ...
  std::filesystem::path path;
  std::uint64_t bytes = 0;
  std::string sha256;
};

struct StageTime {
  std::string stage;
  double seconds = 0.0;  ///< wall-clock time
};

/// Inputs, parameters and cost of a run, enough to repeat it and to compare it with another.
struct Manifest {
  std::string version;
  std::vector<std::string> command_line;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< all effective values by dotted name
  std::vector<ManifestInput> inputs;
  std::vector<std::pair<std::string, std::int64_t>> counts;  ///< "events", "tracks", "frames", ...
  std::vector<StageTime> stages;
  std::string mask;                                  ///< what --mask auto found; written, not read back
  std::vector<events::HotPixel> hot_pixels;          ///< of the filters; written, not read back
  std::optional<double> recorded_s;                  ///< time from the first tracked event frame to the last (s)
  std::vector<TimeNs> rebootstraps;                  ///< stamps of the frames at which the odometry reinitialised
  std::vector<std::pair<std::string, double>> seen;  ///< see DiagnosisValues
  std::vector<LossDiagnosis> losses;                 ///< written, not read back
  std::vector<std::string> warnings;                 ///< see DiagnosisWarnings
  std::string scale;  ///< unit of the trajectory: "arbitrary" or "ground" (m); empty without odometry
};

/// Writes manifest.json with the CPU time and peak memory of this process so far. Throws Error (kOutput).
void WriteManifest(const std::filesystem::path& path, const Manifest& manifest);

/// Reads a manifest.json; parameter values are the texts that WriteManifest was given. Throws Error (kInput) with file
/// and, for invalid JSON, line.
Manifest ReadManifest(const std::filesystem::path& path);

/// Seconds of the recording per second of tracking and odometry; empty without tracking.
std::optional<double> RealTimeFactor(const Manifest& manifest);

/// Peak resident memory of this process so far (MB = 10^6 bytes).
double PeakMemoryMb();

/// CPU time of all threads of this process so far (s).
double CpuTimeS();

}  // namespace evo::report
