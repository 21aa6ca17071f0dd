#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "app/config.hpp"
#include "app/recording.hpp"
#include "app/run/output_folder.hpp"
#include "app/stages/odometry_stage.hpp"
#include "evo/io/track_io.hpp"

namespace evo::app {

namespace {

struct OdometryArguments {
  CommonOptions common;
  std::string tracks;
  std::string calibration;
  std::string sensor;
  ResultOptions results;
};

void RunOdometryCommand(const OdometryArguments& arguments, const std::vector<std::string>& command_line) {
  Config config;
  arguments.common.Apply(&config.parameters);
  CheckRunFolder(arguments.results.out, OdometryResultNames(), arguments.common.force);
  StageRun run(arguments.common, arguments.results, config.parameters, command_line);
  const geometry::Camera camera = OpenCamera(arguments.calibration, arguments.sensor);
  const events::Tracks tracks = run.record.Time("read", [&] { return io::ReadTracks(arguments.tracks); });
  run.record.AddInput("tracks", arguments.tracks);
  run.record.AddInput("calibration", arguments.calibration);
  if (arguments.common.force) RemoveOdometryResults(arguments.results.out);
  const odometry::OdometryResult result = RunOdometryStage(config.odometry, {tracks, arguments.tracks}, camera, &run);
  run.Finish();
  std::cout << FormatOdometry(result) << report::FormatTrajectory(*run.diagnosis.trajectory)
            << report::FormatWarnings(run.diagnosis);
}

}  // namespace

Command AddOdometryCommand(CLI::App& app) {
  auto arguments = std::make_shared<OdometryArguments>();
  auto* const parser = app.add_subcommand(
      "odometry", "Estimate the trajectory from a track file: trajectory.txt, pose_covariance.csv, map.ply");
  parser
      ->add_option("--tracks", arguments->tracks,
                   "Feature tracks: rows 'id t x y' (evo-run, EKLT, rpg) or 't,x,y,theta,id' (HASTE), in any order")
      ->required()
      ->type_name("FILE");
  parser->add_option("--calibration", arguments->calibration, "Calibration: Kalibr camchain YAML or UZH calib.txt")
      ->required()
      ->type_name("FILE");
  AddSensorOption(*parser, arguments->sensor);
  AddOutOption(*parser, arguments->results);
  AddConfigurationOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  parser->footer(
      "Examples:\n"
      "  evo-run odometry --tracks out/tracks.txt --calibration camchain.yaml --out out/odometry\n"
      "  evo-run odometry --tracks haste_tracks.txt --calibration calib.txt --sensor 240x180 --out out/haste\n"
      "  evo-run odometry --tracks out/tracks.txt --calibration camchain.yaml "
      "--set odometry.ground.camera_height_m=1.5 --out out/metres");
  return {parser, [arguments](const auto& command_line) { RunOdometryCommand(*arguments, command_line); }};
}

}  // namespace evo::app
