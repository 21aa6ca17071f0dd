#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evo/core/time.hpp"

namespace evo::report {

struct ManifestInput {
  std::string role;  ///< "events", "calibration", "ground_truth", ...
  std::filesystem::path path;
  std::uint64_t bytes = 0;
  std::string sha256;
};

struct StageTime {
  std::string stage;
  double seconds = 0.0;  ///< wall time
};

/// What a run was made of and what it cost: enough to repeat it and to compare it with another.
struct Manifest {
  std::string version;
  std::vector<std::string> command_line;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< every one, by dotted name, as in effect
  std::vector<ManifestInput> inputs;
  std::vector<std::pair<std::string, std::int64_t>> counts;  ///< "events", "tracks", "frames", ...
  std::vector<StageTime> stages;
  std::optional<double> recorded_s;  ///< time from the first tracked event frame to the last
  std::vector<TimeNs> rebootstraps;  ///< stamps of the frames at which the odometry started anew
  std::string scale;                 ///< what the trajectory's unit is: "arbitrary" or "ground" (m); empty: no odometry
};

/// manifest.json; processor time and peak memory of this process so far are added. Throws Error (kOutput).
void WriteManifest(const std::filesystem::path& path, const Manifest& manifest);

/// Reads one back. Values of parameters are text as WriteManifest was given it. Throws Error (kInput) with file and, if
/// it is not JSON, line.
Manifest ReadManifest(const std::filesystem::path& path);

/// Seconds of the recording per second of tracking and odometry; empty unless events were tracked.
std::optional<double> RealTimeFactor(const Manifest& manifest);

/// Most memory that this process has held so far, MB (10^6 bytes).
double PeakMemoryMb();

/// Processor time that this process has used so far, all threads together, s.
double CpuTimeS();

}  // namespace evo::report
