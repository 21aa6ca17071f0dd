#include "app/recording.hpp"

#include <charconv>
#include <utility>

#include "evo/core/error.hpp"
#include "evo/io/calibration_io.hpp"
#include "evo/io/open_events.hpp"
#include "evo/io/pixel_files.hpp"
#include "evo/io/sequence.hpp"

namespace evo::app {

namespace {

std::optional<io::ImageSize> ParseSensor(const std::string& text) {
  if (text.empty()) return std::nullopt;
  io::ImageSize size;
  const char* const end = text.data() + text.size();
  const auto [x, width_failure] = std::from_chars(text.data(), end, size.width);
  if (width_failure == std::errc() && x != end && *x == 'x') {
    const auto [last, height_failure] = std::from_chars(x + 1, end, size.height);
    if (height_failure == std::errc() && last == end && size.width > 0 && size.height > 0) return size;
  }
  throw Error(ErrorKind::kUsage, "--sensor: '" + text + "' is not a size in pixels such as 240x180");
}

TimeNs ParseSeconds(const std::string& option, const std::string& text) {
  const auto seconds = ParseTime(text);
  if (!seconds || *seconds < 0) {
    throw Error(ErrorKind::kUsage, option + ": '" + text + "' is not a number of seconds after the first event");
  }
  return *seconds;
}

events::Interval ParseInterval(const RecordingArguments& arguments) {
  events::Interval interval{ParseSeconds("--from", arguments.from), std::nullopt};
  if (!arguments.to.empty()) interval.to = ParseSeconds("--to", arguments.to);
  if (interval.to && *interval.to <= interval.from) throw Error(ErrorKind::kUsage, "--to must be greater than --from");
  return interval;
}

events::IgnoredPixels ReadIgnoredPixels(const RecordingArguments& arguments, int width, int height) {
  events::IgnoredPixels ignored;
  if (!arguments.mask.empty() && !IsAutoMask(arguments.mask))
    ignored.masked = io::ReadMask(arguments.mask, width, height);
  if (!arguments.hot_pixels.empty()) ignored.hot = io::ReadHotPixels(arguments.hot_pixels, width, height);
  return ignored;
}

events::AutoMask FindMask(const std::filesystem::path& events, const events::Interval& interval,
                          const geometry::Camera& camera, const events::AutoMaskOptions& options, RunRecord* record) {
  return record->Time("find_mask", [&] {
    return events::FindAutoMask(
        [&](const events::Interval& slice) { return io::OpenEvents(events, slice, camera.width(), camera.height()); },
        interval, camera.width(), camera.height(), options);
  });
}

}  // namespace

void AddMaskOption(CLI::App& command, std::string& mask, const std::string& source) {
  command.add_option("--mask", mask, source)->type_name("IMAGE");
}

bool IsAutoMask(const std::string& mask) { return mask == "auto"; }

void AddSensorOption(CLI::App& command, std::string& sensor) {
  command.add_option("--sensor", sensor, "Size of the sensor in px for a calibration without one; default: 240x180")
      ->type_name("WxH");
}

void AddRecordingOptions(CLI::App& command, RecordingArguments& arguments) {
  command
      .add_option("--events", arguments.events,
                  "Events: MVSEC .hdf5 (left camera), UZH events.txt, or the folder of a sequence with either")
      ->required()
      ->type_name("PATH");
  command
      .add_option("--calibration", arguments.calibration,
                  "Calibration: Kalibr camchain YAML or UZH calib.txt; default: the file in the sequence's folder")
      ->type_name("FILE");
  AddSensorOption(command, arguments.sensor);
  command.add_option("--from", arguments.from, "Start of the interval in s after the first event")
      ->capture_default_str()
      ->type_name("S");
  command.add_option("--to", arguments.to, "End of the interval in s after the first event; default: the last event")
      ->type_name("S");
  AddMaskOption(command, arguments.mask,
                "PNG of the sensor's size; events at its black or transparent pixels are ignored. auto: finds what is "
                "fixed to a driving camera and covers the scene, such as a bonnet");
  command
      .add_option("--save-mask", arguments.save_mask, "Write the mask to this PNG, which can be given back as --mask")
      ->type_name("FILE");
  command
      .add_option("--hot-pixels", arguments.hot_pixels,
                  "Text file of rows 'x y', as --save-hot-pixels writes it: pixels whose events are ignored")
      ->type_name("FILE");
  command
      .add_option("--save-hot-pixels", arguments.save_hot_pixels,
                  "Write the hot pixels, those of --hot-pixels and those found, to this text file")
      ->type_name("FILE");
}

geometry::Camera OpenCamera(const std::filesystem::path& calibration, const std::string& sensor) {
  return geometry::Camera(io::ReadCalibration(calibration, ParseSensor(sensor)));
}

Recording OpenRecording(const RecordingArguments& arguments, const events::EventFilterOptions& options,
                        RunRecord* record) {
  const events::Interval interval = ParseInterval(arguments);
  const io::SequenceFiles files = io::FindSequence(arguments.events);
  std::filesystem::path calibration = arguments.calibration;
  if (calibration.empty()) {
    if (!files.calibration) {
      throw Error(ErrorKind::kUsage,
                  arguments.events + ": the sequence has no calibration; give one with --calibration");
    }
    calibration = *files.calibration;
  }
  geometry::Camera camera = OpenCamera(calibration, arguments.sensor);
  if (!arguments.save_mask.empty() && arguments.mask.empty()) {
    throw Error(ErrorKind::kUsage, "--save-mask needs a mask; give --mask auto or --mask IMAGE");
  }
  auto ignored = ReadIgnoredPixels(arguments, camera.width(), camera.height());
  std::string auto_mask;
  if (IsAutoMask(arguments.mask)) {
    events::AutoMask found = FindMask(files.events, interval, camera, options.auto_mask, record);
    auto_mask = found.summary;
    record->manifest.mask = "auto: " + auto_mask;
    ignored.masked = std::move(found.masked);
  }
  auto reader = std::make_unique<events::FilteredEventReader>(
      io::OpenEvents(files.events, interval, camera.width(), camera.height()), camera.width(), camera.height(), options,
      ignored);
  record->AddLargeInput("events", files.events);
  record->AddInput("calibration", calibration);
  if (!arguments.mask.empty() && !IsAutoMask(arguments.mask)) record->AddInput("mask", arguments.mask);
  if (!arguments.hot_pixels.empty()) record->AddInput("hot_pixels", arguments.hot_pixels);
  return {camera,
          files.events,
          std::move(reader),
          interval,
          files.ground_truth,
          arguments.save_hot_pixels,
          arguments.save_mask,
          std::move(ignored.masked),
          auto_mask};
}

std::string SequenceName(const std::filesystem::path& file) {
  std::string name = file.stem().string();
  if (name == "groundtruth" || name == "events") {
    return std::filesystem::absolute(file).parent_path().filename().string();
  }
  for (const std::string ending : {"_gt", "_groundtruth", "_data"}) {
    if (name.ends_with(ending) && name.size() > ending.size()) name.resize(name.size() - ending.size());
  }
  return name;
}

}  // namespace evo::app
