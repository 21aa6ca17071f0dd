#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "app/output_folder.hpp"
#include "app/stages.hpp"

namespace evo::app {

namespace {

struct OdometryArguments {
  CommonOptions common;
  std::string tracks;
  std::string calibration;
  std::string sensor;
  StageOptions stage;
};

void RunOdometryCommand(const OdometryArguments& arguments, const std::vector<std::string>& command_line) {
  Config config;
  arguments.common.Apply(&config.parameters);
  auto results = OdometryResultNames();
  results.emplace_back("manifest.json");
  CheckOutputFolder(arguments.stage.out, results, arguments.common.force);
  RunRecord record(command_line, config.parameters);
  const Camera camera = OpenCamera(arguments.calibration, arguments.sensor);
  const Tracks tracks = record.Time("read", [&] { return ReadTracks(arguments.tracks); });
  record.AddInput("tracks", arguments.tracks);
  record.AddInput("calibration", arguments.calibration);
  const InterruptGuard guard(arguments.stage.out);
  ThreadPool pool(arguments.common.threads);
  const StageContext context{config, &pool, &record, arguments.stage, !arguments.common.quiet};
  const OdometryResult result = RunOdometryStage(context, tracks, arguments.tracks, camera);
  WriteManifest(context.options.out / "manifest.json", record.manifest);
  std::cout << FormatOdometry(result);
}

}  // namespace

Command AddOdometryCommand(CLI::App& app) {
  auto arguments = std::make_shared<OdometryArguments>();
  auto* const parser = app.add_subcommand("odometry", "Trajectory and map from a track file: trajectory.txt, map.ply");
  parser
      ->add_option("--tracks", arguments->tracks,
                   "rows 'id t x y' (this tool, EKLT, rpg) or 't,x,y,theta,id' (HASTE), in any order")
      ->required()
      ->type_name("FILE");
  parser->add_option("--calibration", arguments->calibration, "Kalibr camchain YAML or UZH calib.txt")
      ->required()
      ->type_name("FILE");
  AddSensorOption(*parser, arguments->sensor);
  AddStageOptions(*parser, arguments->stage);
  AddConfigurationOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  parser->footer("Example:\n  evo-run odometry --tracks out/tracks.txt --calibration camchain.yaml --out out/odometry");
  return {parser, [arguments](const auto& command_line) { RunOdometryCommand(*arguments, command_line); }};
}

}  // namespace evo::app
