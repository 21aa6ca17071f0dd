#include <iostream>
#include <limits>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "app/error_place.hpp"
#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "app/output_folder.hpp"
#include "app/run_record.hpp"
#include "app/scene_config.hpp"
#include "app/sequence_output.hpp"
#include "app/staged_folder.hpp"
#include "evo/core/error.hpp"
#include "evo/core/format.hpp"
#include "evo/core/parallel.hpp"
#include "evo/core/progress.hpp"
#include "evo/simulation/simulate.hpp"
#include "evo/simulation/simulated_run.hpp"

namespace evo::app {

namespace {

namespace fs = std::filesystem;

struct SimulateArguments {
  CommonOptions common;  ///< its config_file is the scene
  std::string format = "mvsec";
  fs::path out;
  std::optional<int> seed;
  double from_s = 0.0;
  std::optional<double> duration_s;
  double preview_every_s = 0.0;
  bool print = false;
};

/// The part of the scene that --from and --duration name.
simulation::SimulatedRun ChosenPart(const SimulateArguments& arguments, const simulation::SceneOptions& scene,
                                    const simulation::SimulatedRun& run) {
  const TimeNs from = FromSeconds(arguments.from_s);
  const TimeNs duration = arguments.duration_s ? FromSeconds(*arguments.duration_s) : run.duration - from;
  if (duration > 0 && from + duration <= run.duration) return simulation::PartOf(run, from, duration);
  const std::string longer =
      scene.motion == "file" ? "give a longer trajectory" : "raise motion." + scene.motion + ".duration_s";
  throw Error(ErrorKind::kUsage, "--from, --duration: the motion ends after " + FormatTime(run.duration) +
                                     " s; ask for less, or " + longer);
}

void PrintSummary(const std::string& name, const geometry::Camera& camera, const geometry::Trajectory& poses,
                  const simulation::SimulationCounts& counts, double wall_s, int threads) {
  const double duration_s = ToSeconds(poses.back().t);
  const double pixels = static_cast<double>(camera.width()) * camera.height();
  const auto events = static_cast<double>(counts.events);
  const auto positive = static_cast<double>(counts.positive);
  std::cout << "sequence   " << name
            << Format(": %.1f s, %.1f m, %d x %d px\n", duration_s, geometry::PathLength(poses), camera.width(),
                      camera.height())
            << Format("events     %zu, %.3f M/s, %.2f negative for each positive one\n", counts.events,
                      1e-6 * events / duration_s, positive > 0 ? (events - positive) / positive : 0.0)
            << Format("rendering  each pixel %.0f times a second, %zu images, %zu depth maps\n",
                      static_cast<double>(counts.pixel_renders) / pixels / duration_s, counts.images, counts.depth_maps)
            << Format("speed      %.2f s of computing for a simulated second on %d threads\n", wall_s / duration_s,
                      threads);
}

void PrintFiles(const fs::path& out, const std::vector<std::string>& names) {
  for (const auto& name : names) {
    const fs::path path = out / name;
    if (!fs::is_regular_file(path)) continue;
    const auto bytes = static_cast<double>(fs::file_size(path));
    std::cout << "file       " << path.string()
              << Format(bytes < 1e6 ? ", %.1f kB\n" : ", %.1f MB\n", bytes < 1e6 ? 1e-3 * bytes : 1e-6 * bytes);
  }
  std::cout << "results    " << out.string() << '\n';
}

/// What is to be made, checked.
struct Order {
  Order(const SimulateArguments& arguments, const SceneConfig& config)
      : format(arguments.format == "uzh" ? SequenceFormat::kUzh : SequenceFormat::kMvsec) {
    const simulation::SimulationOptions& simulation = config.scene.simulation;
    if (arguments.out.empty()) {
      throw Error(ErrorKind::kUsage, "simulate: --out is required; see evo-run simulate --help");
    }
    if (arguments.preview_every_s > 0.0 && simulation.image_hz == 0.0) {
      throw Error(ErrorKind::kUsage, "--preview-every shows images, but simulation.image_hz is 0; raise it");
    }
    if (config.output.flow && simulation.depth_hz == 0.0) {
      throw Error(ErrorKind::kConfiguration,
                  "output.flow comes with the depth maps, but simulation.depth_hz is 0; raise it");
    }
    const std::string scene_file = arguments.common.config_file;
    place = scene_file.empty() ? "simulate" : scene_file;
    name = scene_file.empty() ? config.scene.kind : fs::path(scene_file).stem().string();
    auto results = SequenceResultNames(format, name);
    results.emplace_back("manifest.json");
    CheckOutputFolder(arguments.out, results, arguments.common.force);
  }

  SequenceFormat format;
  std::string place;  ///< that errors name
  std::string name;   ///< of the sequence
};

void AddInputs(const SimulateArguments& arguments, const simulation::SceneOptions& scene, RunRecord* record) {
  if (!arguments.common.config_file.empty()) record->AddInput("scene", arguments.common.config_file);
  if (scene.motion == "file") record->AddInput("motion", scene.motion_file);
  if (fs::is_regular_file(scene.calibration)) record->AddInput("calibration", scene.calibration);
}

void AddCounts(const simulation::SimulationCounts& counts, RunRecord* record) {
  record->AddCount("events", counts.events);
  record->AddCount("positive_events", counts.positive);
  record->AddCount("images", counts.images);
  record->AddCount("depth_maps", counts.depth_maps);
  record->AddCount("pixel_renders", counts.pixel_renders);
}

void RunSimulate(const SimulateArguments& arguments, const std::vector<std::string>& command_line) {
  SceneConfig config;
  arguments.common.Apply(&config.parameters);
  if (arguments.seed) config.scene.seed = *arguments.seed;
  if (arguments.print) {
    std::cout << config.parameters.ToYaml();
    return;
  }
  const Order order(arguments, config);
  const simulation::SimulatedRun run =
      NamingPlace(order.place, [&] { return ChosenPart(arguments, config.scene, simulation::MakeRun(config.scene)); });
  const geometry::Trajectory poses = simulation::SamplePoses(run.T_world_cam, run.duration, config.output.pose_hz);
  RunRecord record(command_line, config.parameters);
  AddInputs(arguments, config.scene, &record);

  const InterruptGuard guard(arguments.out);
  ThreadPool pool(arguments.common.threads);
  StagedFolder staged(arguments.out);
  const auto output = MakeSequenceOutput(order.format, staged.path(), order.name, run, poses, config.output,
                                         config.scene.simulation.depth_hz > 0.0, &pool);
  PreviewOutput preview(output.get(), staged.path() / "preview", FromSeconds(arguments.preview_every_s));
  simulation::SimulationSink* const sink =
      arguments.preview_every_s > 0.0 ? static_cast<simulation::SimulationSink*>(&preview) : output.get();
  const simulation::SimulationCounts counts = record.Time("simulate", [&] {
    Progress progress("simulate", !arguments.common.quiet);
    return simulation::Simulate(run, config.scene, &pool, sink, &progress);
  });
  output->Commit();
  AddCounts(counts, &record);
  report::WriteManifest(staged.path() / "manifest.json", record.manifest);
  if (arguments.common.force) RemoveSequence(arguments.out, order.format, order.name);
  staged.Commit();
  PrintSummary(order.name, run.camera, poses, counts, record.manifest.stages.back().seconds, pool.size());
  PrintFiles(arguments.out, SequenceResultNames(order.format, order.name));
}

}  // namespace

Command AddSimulateCommand(CLI::App& app) {
  auto arguments = std::make_shared<SimulateArguments>();
  auto* const parser = app.add_subcommand("simulate", "Make a sequence with exact ground truth from a scene file");
  parser->add_option("SCENE", arguments->common.config_file, "YAML file; default: a street by day, see --print")
      ->type_name("");
  parser->add_option("--format", arguments->format, "layout of the files: mvsec (HDF5) or uzh (text and PNG)")
      ->check(CLI::IsMember({"mvsec", "uzh"}).description(""))
      ->capture_default_str()
      ->type_name("mvsec|uzh");
  parser->add_option("--out", arguments->out, "folder for the sequence; created if need be")->type_name("DIR");
  parser->add_option("--seed", arguments->seed, "instead of the scene's own: another street, other noise")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()).description(""))
      ->type_name("N");
  parser->add_option("--from", arguments->from_s, "begin this many seconds into the scene")
      ->check(NumberBetween(0.0, 1e6))
      ->type_name("S");
  parser->add_option("--duration", arguments->duration_s, "length; default: up to the scene's end")
      ->check(NumberBetween(0.001, 1e6))
      ->type_name("S");
  parser->add_option("--preview-every", arguments->preview_every_s, "draw image and events every S seconds")
      ->check(NumberBetween(0.001, 1e6))
      ->type_name("S");
  parser->add_flag("--print", arguments->print, "print every parameter of the scene and its meaning as YAML instead");
  AddSettingOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  parser->footer(
      "Example:\n  evo-run simulate configs/scenes/driving_day.yaml --from 50 --duration 8 --out out/driving_day");
  return {parser, [arguments](const auto& command_line) { RunSimulate(*arguments, command_line); }};
}

}  // namespace evo::app
