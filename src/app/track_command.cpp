#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "app/event_drawing.hpp"
#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "app/output_folder.hpp"
#include "app/stages.hpp"

namespace evo::app {

namespace {

struct TrackArguments {
  CommonOptions common;
  RecordingArguments recording;
  StageOptions stage;
};

void RunTrack(const TrackArguments& arguments, const std::vector<std::string>& command_line) {
  Config config;
  arguments.common.Apply(&config.parameters);
  auto results = TrackingResultNames();
  results.emplace_back("manifest.json");
  CheckOutputFolder(arguments.stage.out, results, arguments.common.force);
  RunRecord record(command_line, config.parameters);
  Recording recording = OpenRecording(arguments.recording, &record);
  if (arguments.common.force) RemoveDrawings(arguments.stage.out / "images");
  const InterruptGuard guard(arguments.stage.out);
  ThreadPool pool(arguments.common.threads);
  const StageContext context{config, &pool, &record, arguments.stage, !arguments.common.quiet};
  const TrackingOutcome outcome = RunTrackingStage(context, &recording);
  WriteManifest(context.options.out / "manifest.json", record.manifest);
  std::cout << FormatTracking(outcome) << FormatSpeed(record.manifest, pool.size());
}

}  // namespace

Command AddTrackCommand(CLI::App& app) {
  auto arguments = std::make_shared<TrackArguments>();
  auto* const parser = app.add_subcommand("track", "Track features in the events: tracks.txt and lifetime.csv");
  AddRecordingOptions(*parser, arguments->recording);
  AddStageOptions(*parser, arguments->stage);
  AddDrawingOption(*parser, arguments->stage);
  AddConfigurationOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  parser->footer(
      "Example:\n  evo-run track --events outdoor_day2_data.hdf5 --calibration camchain-imucam-outdoor_day.yaml --from "
      "12 --to 72 --draw-every 5 --out out/day2");
  return {parser, [arguments](const auto& command_line) { RunTrack(*arguments, command_line); }};
}

}  // namespace evo::app
