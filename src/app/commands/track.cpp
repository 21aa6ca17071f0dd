#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "app/config.hpp"
#include "app/run/output_folder.hpp"
#include "app/stages/tracking_stage.hpp"

namespace evo::app {

namespace {

struct TrackArguments {
  CommonOptions common;
  RecordingArguments recording;
  ResultOptions results;
};

void RunTrack(const TrackArguments& arguments, const std::vector<std::string>& command_line) {
  Config config;
  arguments.common.Apply(&config.parameters);
  CheckRunFolder(arguments.results.out, TrackingResultNames(), arguments.common.force);
  StageRun run(arguments.common, arguments.results, config.parameters, command_line);
  Recording recording = OpenRecording(arguments.recording, config.filters, &run.record);
  if (arguments.common.force) RemoveTrackingResults(arguments.results.out);
  const TrackingOutcome outcome = RunTrackingStage(config.tracker, &recording, &run);
  run.Finish();
  std::cout << FormatTracking(outcome) << report::FormatFeatures(*run.diagnosis.features) << FormatSpeed(run)
            << report::FormatWarnings(run.diagnosis);
}

}  // namespace

Command AddTrackCommand(CLI::App& app) {
  auto arguments = std::make_shared<TrackArguments>();
  auto* const parser = app.add_subcommand("track", "Track features in the events: tracks.txt and lifetime.csv");
  AddRecordingOptions(*parser, arguments->recording);
  AddOutOption(*parser, arguments->results);
  AddPlotOption(*parser, arguments->results);
  AddDrawingOption(*parser, arguments->results);
  AddConfigurationOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  parser->footer(
      "Examples:\n"
      "  evo-run track --events data_samples/street --out out/street_tracks\n"
      "  evo-run track --events outdoor_day2_data.hdf5 --calibration camchain-imucam-outdoor_day.yaml --from 12 --to "
      "72 "
      "--draw-every 5 --out out/day2\n"
      "  evo-run track --events data_samples/street --set tracker.method=klt --out out/street_klt\n"
      "  evo-run track --events outdoor_day2_data.hdf5 --calibration camchain-imucam-outdoor_day.yaml --mask auto "
      "--save-mask bonnet.png --out out/day2_masked");
  return {parser, [arguments](const auto& command_line) { RunTrack(*arguments, command_line); }};
}

}  // namespace evo::app
