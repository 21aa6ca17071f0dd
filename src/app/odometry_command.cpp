#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "app/stages.hpp"
#include "evo/io/track_io.hpp"

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
  StageContext context(arguments.common, arguments.stage, OdometryResultNames(), command_line);
  const geometry::Camera camera = OpenCamera(arguments.calibration, arguments.sensor);
  const events::Tracks tracks = context.record.Time("read", [&] { return io::ReadTracks(arguments.tracks); });
  context.record.AddInput("tracks", arguments.tracks);
  context.record.AddInput("calibration", arguments.calibration);
  if (context.force) RemoveOdometryResults(context.options.out);
  const odometry::OdometryResult result = RunOdometryStage(&context, tracks, arguments.tracks, camera);
  context.Finish();
  std::cout << FormatOdometry(result);
}

}  // namespace

Command AddOdometryCommand(CLI::App& app) {
  auto arguments = std::make_shared<OdometryArguments>();
  auto* const parser = app.add_subcommand(
      "odometry",
      "Trajectory, its uncertainty and map from a track file: trajectory.txt, pose_covariance.csv, map.ply");
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
