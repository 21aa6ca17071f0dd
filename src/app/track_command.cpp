#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "app/stages.hpp"

namespace evo::app {

namespace {

struct TrackArguments {
  CommonOptions common;
  RecordingArguments recording;
  StageOptions stage;
};

void RunTrack(const TrackArguments& arguments, const std::vector<std::string>& command_line) {
  StageContext context(arguments.common, arguments.stage, TrackingResultNames(), command_line);
  Recording recording = OpenRecording(arguments.recording, &context.record);
  if (context.force) RemoveTrackingResults(context.options.out);
  const TrackingOutcome outcome = RunTrackingStage(&context, &recording);
  context.Finish();
  std::cout << FormatTracking(outcome) << FormatSpeed(context.record.manifest, context.pool.size());
}

}  // namespace

Command AddTrackCommand(CLI::App& app) {
  auto arguments = std::make_shared<TrackArguments>();
  auto* const parser = app.add_subcommand("track", "Track features in the events: tracks.txt and lifetime.csv");
  AddRecordingOptions(*parser, arguments->recording);
  AddStageOptions(*parser, arguments->stage);
  AddDrawingOptions(*parser, arguments->stage);
  AddConfigurationOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  parser->footer(
      "Example:\n  evo-run track --events outdoor_day2_data.hdf5 --calibration camchain-imucam-outdoor_day.yaml --from "
      "12 --to 72 --draw-every 5 --out out/day2");
  return {parser, [arguments](const auto& command_line) { RunTrack(*arguments, command_line); }};
}

}  // namespace evo::app
