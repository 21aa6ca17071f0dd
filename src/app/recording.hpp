#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "app/run_record.hpp"
#include "evo/events/event_reader.hpp"
#include "evo/geometry/camera.hpp"

namespace evo::app {

/// What the user says about a recording of events.
struct RecordingArguments {
  std::string events;
  std::string calibration;
  std::string sensor;
  std::string from = "0";
  std::string to;
};

/// --events, --calibration, --sensor, --from and --to.
void AddRecordingOptions(CLI::App& command, RecordingArguments& arguments);

/// A camera from --calibration and --sensor. Throws Error.
geometry::Camera OpenCamera(const std::filesystem::path& calibration, const std::string& sensor);
/// --sensor, for commands without events.
void AddSensorOption(CLI::App& command, std::string& sensor);

/// A recording that has been found and whose beginning has been read.
struct Recording {
  geometry::Camera camera;
  std::filesystem::path events;
  std::unique_ptr<events::EventReader> reader;
  events::Interval interval;
  std::optional<std::filesystem::path> ground_truth;  ///< found beside the events
};

/// Finds the files, reads the calibration, opens the events and notes both in `record`. Throws Error.
Recording OpenRecording(const RecordingArguments& arguments, RunRecord* record);

}  // namespace evo::app
