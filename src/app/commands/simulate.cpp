#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "app/options.hpp"
#include "app/run/error_context.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/output_folder.hpp"
#include "app/run/run_record.hpp"
#include "app/run/staged_folder.hpp"
#include "app/simulation/preview_output.hpp"
#include "app/simulation/scene_config.hpp"
#include "app/simulation/sequence_output.hpp"
#include "evo/core/error.hpp"
#include "evo/core/logging.hpp"
#include "evo/core/output_file.hpp"
#include "evo/core/parallel.hpp"
#include "evo/core/progress.hpp"
#include "evo/simulation/random_scene.hpp"
#include "evo/simulation/simulate.hpp"
#include "evo/simulation/simulated_run.hpp"

namespace evo::app {

namespace {

namespace fs = std::filesystem;

struct SimulateArguments {
  CommonOptions common;  ///< config_file is the scene
  std::string format = "mvsec";
  fs::path out;
  std::optional<int> seed;
  double from_s = 0.0;
  std::optional<double> duration_s;
  double preview_every_s = 0.0;
  bool print = false;

  std::string place() const { return common.config_file.empty() ? "simulate" : common.config_file; }
};

/// The part of the scene between --from and --from + --duration.
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

/// The numbers of the summary that the counts do not hold.
struct Effort {
  double wall_s = 0.0;
  int threads = 0;
};

std::string FormatSummary(const std::string& name, const geometry::Camera& camera, const geometry::Trajectory& poses,
                          const simulation::SimulationCounts& counts, const Effort& effort) {
  const double duration_s = ToSeconds(poses.back().t);
  const double pixels = static_cast<double>(camera.width()) * camera.height();
  const auto events = static_cast<double>(counts.events);
  const auto positive = static_cast<double>(counts.positive);
  return fmt::format("sequence   {}: {:.1f} s, {:.1f} m, {} x {} px\n", name, duration_s, geometry::PathLength(poses),
                     camera.width(), camera.height()) +
         fmt::format("events     {}, {:.3f} M/s, {:.2f} negative for each positive one\n", counts.events,
                     1e-6 * events / duration_s, positive > 0 ? (events - positive) / positive : 0.0) +
         fmt::format("rendering  {:.0f} times a second for each pixel, {} images, {} depth maps\n",
                     static_cast<double>(counts.pixel_renders) / pixels / duration_s, counts.images,
                     counts.depth_maps) +
         fmt::format("speed      {:.2f} s of computing for a simulated second on {} threads\n",
                     effort.wall_s / duration_s, effort.threads);
}

std::string FormatFiles(const fs::path& out, const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) {
    const fs::path path = out / name;
    if (!fs::is_regular_file(path)) continue;
    const auto bytes = static_cast<double>(fs::file_size(path));
    text += fmt::format("file       {}, {:.1f} {}\n", path.string(), bytes < 1e6 ? 1e-3 * bytes : 1e-6 * bytes,
                        bytes < 1e6 ? "kB" : "MB");
  }
  return text;
}

/// The files to be made.
struct SequenceOrder {
  SequenceFormat format;
  std::string name;
};

/// Throws Error if the arguments and parameters contradict each other or the output folder cannot be used.
SequenceOrder CheckOrder(const SimulateArguments& arguments, const SceneConfig& config) {
  const simulation::SimulationOptions& simulation = config.scene.simulation;
  if (arguments.out.empty()) {
    throw Error(ErrorKind::kUsage, "simulate: --out is required; see evo-run simulate --help");
  }
  if (arguments.preview_every_s > 0.0 && simulation.image_hz == 0.0) {
    throw Error(ErrorKind::kUsage, "--preview-every needs images, but simulation.image_hz is 0; raise it");
  }
  if (config.output.flow && simulation.depth_hz == 0.0) {
    throw Error(ErrorKind::kConfiguration, "output.flow needs depth maps, but simulation.depth_hz is 0; raise it");
  }
  const std::string scene_file = arguments.common.config_file;
  SequenceOrder order{arguments.format == "uzh" ? SequenceFormat::kUzh : SequenceFormat::kMvsec,
                      scene_file.empty() ? config.scene.kind : fs::path(scene_file).stem().string()};
  CheckRunFolder(arguments.out, SequenceResultNames(order.format, order.name), arguments.common.force);
  return order;
}

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

/// Simulates `run` into `output`, with previews in `preview_folder` if asked for.
simulation::SimulationCounts Simulate(const SimulateArguments& arguments, const simulation::SceneOptions& scene,
                                      const simulation::SimulatedRun& run, const fs::path& preview_folder,
                                      ThreadPool* pool, SequenceOutput* output) {
  PreviewOutput preview(output, preview_folder, FromSeconds(arguments.preview_every_s));
  simulation::SimulationSink* const sink =
      arguments.preview_every_s > 0.0 ? static_cast<simulation::SimulationSink*>(&preview) : output;
  Progress progress("simulate", !arguments.common.quiet);
  return simulation::Simulate(run, scene, pool, sink, &progress);
}

/// Sets the parameters from the scene file and the settings. Returns what was drawn of a random scene.
std::optional<simulation::DrawnNames> LoadScene(const SimulateArguments& arguments, SceneConfig* config) {
  CommonOptions settings = arguments.common;
  SetUpLogging(settings.quiet ? -1 : settings.verbose);
  std::optional<simulation::DrawnNames> drawn;
  if (!settings.config_file.empty()) {
    drawn = simulation::LoadScene(settings.config_file, arguments.seed, &config->scene, &config->parameters);
  }
  settings.config_file.clear();
  settings.Apply(&config->parameters);
  if (arguments.seed) config->scene.seed = *arguments.seed;
  return drawn;
}

/// The scene as a file that simulates the same again.
std::string FormatScene(const SimulateArguments& arguments, const SceneConfig& config,
                        const std::optional<simulation::DrawnNames>& drawn) {
  std::string text;
  if (drawn) {
    text =
        fmt::format("# Drawn from {} by seed {}\n# drawn:", fs::path(arguments.common.config_file).filename().string(),
                    config.scene.seed);
    for (const auto& [name, alternative] : *drawn) text += fmt::format(" {}={}", name, alternative);
    text += '\n';
  }
  return text + config.parameters.ToYaml();
}

void RunSimulate(const SimulateArguments& arguments, const std::vector<std::string>& command_line) {
  SceneConfig config;
  const auto drawn = LoadScene(arguments, &config);
  if (arguments.print) {
    std::cout << FormatScene(arguments, config, drawn);
    return;
  }
  const SequenceOrder order = CheckOrder(arguments, config);
  const simulation::SimulatedRun run = WithErrorContext(
      arguments.place(), [&] { return ChosenPart(arguments, config.scene, simulation::MakeRun(config.scene)); });
  const geometry::Trajectory poses = simulation::SamplePoses(run.T_world_cam, run.duration, config.output.pose_hz);
  RunRecord record(command_line, config.parameters);
  AddInputs(arguments, config.scene, &record);

  const InterruptGuard guard(arguments.out);
  ThreadPool pool(arguments.common.threads);
  StagedFolder staged(arguments.out);
  const SequenceSource source{run, poses, config.scene.simulation.depth_hz > 0.0, &pool};
  const auto output = MakeSequenceOutput(order.format, {staged.path(), order.name}, source, config.output);
  const simulation::SimulationCounts counts = record.Time("simulate", [&] {
    return Simulate(arguments, config.scene, run, staged.path() / "preview", &pool, output.get());
  });
  output->Commit();
  AddCounts(counts, &record);
  if (drawn) WriteText(staged.path() / "scene.yaml", FormatScene(arguments, config, drawn));
  report::WriteManifest(staged.path() / "manifest.json", record.manifest);
  if (arguments.common.force) RemoveSequence(arguments.out, order.format, order.name);
  staged.Commit();
  std::cout << FormatSummary(order.name, run.camera, poses, counts,
                             {record.manifest.stages.back().seconds, pool.size()})
            << FormatFiles(arguments.out, SequenceResultNames(order.format, order.name)) << "results    "
            << arguments.out.string() << '\n';
}

}  // namespace

Command AddSimulateCommand(CLI::App& app) {
  auto arguments = std::make_shared<SimulateArguments>();
  auto* const parser = app.add_subcommand("simulate", "Simulate a sequence with exact ground truth from a scene file");
  parser
      ->add_option("SCENE", arguments->common.config_file,
                   "YAML file of the scene, as --print writes it; default: a street by day")
      ->type_name("");
  parser->add_option("--format", arguments->format, "Format of the sequence: mvsec (HDF5) or uzh (text and PNG)")
      ->check(CLI::IsMember({"mvsec", "uzh"}).description(""))
      ->capture_default_str()
      ->type_name("mvsec|uzh");
  parser
      ->add_option("--out", arguments->out,
                   "Folder for the sequence, created if it does not exist; required unless --print")
      ->type_name("DIR");
  parser->add_option("--seed", arguments->seed, "Seed of the world and the noise; default: scene.seed")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()).description(""))
      ->type_name("N");
  parser->add_option("--from", arguments->from_s, "Start of the sequence in s after the start of the scene; default: 0")
      ->check(NumberBetween(0.0, 1e6))
      ->type_name("S");
  parser
      ->add_option("--duration", arguments->duration_s,
                   "Duration of the sequence in s; default: to the end of the scene")
      ->check(NumberBetween(0.001, 1e6))
      ->type_name("S");
  parser
      ->add_option("--preview-every", arguments->preview_every_s,
                   "Interval in s at which an image and its events are drawn into preview/; default: never")
      ->check(NumberBetween(0.001, 1e6))
      ->type_name("S");
  parser->add_flag("--print", arguments->print,
                   "Print every parameter of the scene with its value, range and meaning as YAML; simulate nothing");
  AddSettingOptions(*parser, arguments->common);
  AddComputeOptions(*parser, arguments->common);
  parser->footer(
      "Examples:\n"
      "  evo-run simulate configs/scenes/driving_day.yaml --from 50 --duration 8 --out out/driving_day\n"
      "  evo-run simulate configs/scenes/handheld_boxes.yaml --format uzh --seed 7 --out out/boxes\n"
      "  evo-run simulate --print > scene.yaml");
  return {parser, [arguments](const auto& command_line) { RunSimulate(*arguments, command_line); }};
}

}  // namespace evo::app
