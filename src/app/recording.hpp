#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/run/run_record.hpp"
#include "evo/events/filtered_event_reader.hpp"
#include "evo/geometry/camera.hpp"

namespace evo::app {

/// The arguments that name a recording of events.
struct RecordingArguments {
  std::string events;
  std::string calibration;
  std::string sensor;
  std::string from = "0";
  std::string to;
  std::string mask;             ///< a file, or "auto"; empty: none
  std::string save_mask;        ///< empty: it is not saved
  std::string hot_pixels;       ///< empty: none are known
  std::string save_hot_pixels;  ///< empty: they are not saved
};

/// --events, --calibration, --sensor, --from, --to, --mask, --save-mask, --hot-pixels and --save-hot-pixels.
void AddRecordingOptions(CLI::App& command, RecordingArguments& arguments);

/// Reads the camera from --calibration and --sensor. Throws Error.
geometry::Camera OpenCamera(const std::filesystem::path& calibration, const std::string& sensor);
/// --sensor.
void AddSensorOption(CLI::App& command, std::string& sensor);
/// --mask; `source` is where the mask may come from.
void AddMaskOption(CLI::App& command, std::string& mask, const std::string& source);
/// Whether the value of --mask asks for a mask that is found in the events.
bool IsAutoMask(const std::string& mask);

/// An open recording with its camera.
struct Recording {
  geometry::Camera camera;
  std::filesystem::path events;
  std::unique_ptr<events::FilteredEventReader> reader;
  events::Interval interval;
  std::optional<std::filesystem::path> ground_truth;  ///< the file beside the events, if any
  std::filesystem::path save_hot_pixels;              ///< empty: they are not saved
  std::filesystem::path save_mask;                    ///< empty: it is not saved
  std::vector<std::uint8_t> masked;                   ///< as IgnoredPixels
  std::string auto_mask;                              ///< summary of a mask that was found in the events
};

/// Finds the files, reads the calibration and the masks or finds the mask, opens the events behind the filters of
/// `options` and adds all inputs to `record`. Throws Error.
Recording OpenRecording(const RecordingArguments& arguments, const events::EventFilterOptions& options,
                        RunRecord* record);

/// The name of the sequence to which a file of events or ground truth belongs: "drive" for drive_data.hdf5 and
/// drive_gt.hdf5, the folder's name for events.txt and groundtruth.txt.
std::string SequenceName(const std::filesystem::path& file);

}  // namespace evo::app
