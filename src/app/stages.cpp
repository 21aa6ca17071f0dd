#include "app/stages.hpp"

#include <spdlog/spdlog.h>

#include <optional>
#include <span>

#include "app/error_place.hpp"
#include "app/evaluation_results.hpp"
#include "app/event_drawing.hpp"
#include "app/output_folder.hpp"
#include "app/track_results.hpp"
#include "evo/core/error.hpp"
#include "evo/core/format.hpp"
#include "evo/core/output_file.hpp"
#include "evo/core/progress.hpp"
#include "evo/io/trajectory_io.hpp"
#include "evo/odometry/map_writer.hpp"
#include "evo/report/evaluation_tables.hpp"
#include "evo/report/figures.hpp"
#include "evo/report/latex_tables.hpp"
#include "evo/report/terminal_summary.hpp"
#include "evo/tracking/track_events.hpp"

namespace evo::app {

namespace {

/// Where the interval ends, also if it was asked for beyond the end of the recording.
TimeNs EndOfInterval(const Recording& recording) {
  if (!recording.interval.to) return recording.reader->last_stamp();
  const TimeNs to = recording.reader->first_stamp() + *recording.interval.to;
  try {
    return std::min(to, recording.reader->last_stamp());
  } catch (const Error&) {
    return to;  // damage beyond the interval is no concern of this run
  }
}

/// Four frames in the middle of the interval, or four every `draw_every_s` seconds from its start on.
DrawingSchedule ScheduleDrawings(const StageContext& context, const Recording& recording) {
  const TimeNs from = recording.reader->first_stamp() + recording.interval.from;
  if (context.options.draw_every_s > 0.0) return {from, FromSeconds(context.options.draw_every_s)};
  return {from + (EndOfInterval(recording) - from) / 2 - 2 * FromSeconds(context.config.tracker.frame_interval_s),
          std::nullopt};
}

void DrawTrackFigures(const std::filesystem::path& folder, const evaluation::LifetimeStatistics& lifetimes,
                      std::span<const report::LiveFeatures> live) {
  report::Gnuplot gnuplot(folder);
  gnuplot.Draw("lifetime", report::LifetimeFigure("lifetime", lifetimes));
  gnuplot.Draw("lifetime_seconds", report::LifetimeSecondsFigure("lifetime_seconds", lifetimes));
  gnuplot.Draw("live_features", report::LiveFeaturesFigure("live_features", live));
}

std::string FormatGroundScale(const odometry::GroundScale& scale) {
  if (!scale.found) return "scale      arbitrary and not held: too short a way over a road\n";
  return Format("scale      %s, by %zu tracks on the ground along %.0f %% of the path, uncertain by %.2f %%\n",
                scale.metric ? "metres" : "arbitrary but held", scale.tracks, 100.0 * scale.covered_ratio,
                100.0 * scale.relative_sigma);
}

}  // namespace

StageContext::StageContext(const CommonOptions& common, StageOptions stage_options, std::vector<std::string> results,
                           const std::vector<std::string>& command_line)
    : options(std::move(stage_options)),
      force(common.force),
      show_progress(!common.quiet),
      record(command_line,
             [&]() -> const Parameters& {
               common.Apply(&config.parameters);
               results.emplace_back("manifest.json");
               CheckOutputFolder(options.out, results, force);
               return config.parameters;
             }()),
      guard(options.out),
      pool(common.threads) {}

void StageContext::Finish() {
  record.FinishChecksums();
  report::WriteManifest(options.out / "manifest.json", record.manifest);
}

void AddStageOptions(CLI::App& command, StageOptions& options) {
  command.add_option("--out", options.out, "folder for the results")->required()->type_name("DIR");
}

void AddDrawingOptions(CLI::App& command, StageOptions& options) {
  command.add_flag("--no-plots", options.no_plots, "write tables only");
  command
      .add_option("--draw-every", options.draw_every_s,
                  "draw four event frames with their tracks into images/ every so many seconds; default: once, in the "
                  "middle")
      ->check(NumberBetween(1e-3, 1e6))
      ->type_name("S");
}

std::vector<std::string> TrackingResultNames() { return {"tracks.txt", "lifetime.csv", "tables/lifetime.tex"}; }

void RemoveTrackingResults(const std::filesystem::path& folder) {
  RemoveResults(folder, R"(manifest\.json|tracks\.txt|lifetime\.csv)");
  RemoveResults(folder / "tables", R"(lifetime\.tex)");
  RemovePlots(folder, "lifetime|lifetime_seconds|live_features");
  RemoveDrawings(folder / "images");
}

TrackingOutcome RunTrackingStage(StageContext* context, Recording* recording, events::Tracks* kept) {
  const bool draw = context->options.draw_every_s > 0.0 || !context->options.no_plots;
  EventDrawing drawing(context->options.out / "images", recording->reader->first_stamp(),
                       draw ? ScheduleDrawings(*context, *recording) : DrawingSchedule());
  TrackResults results(context->options.out / "tracks.txt", {tracking::DescribePositions(context->config.tracker)},
                       kept);
  TrackingOutcome outcome;
  outcome.result = context->record.Time("track", [&] {
    Progress progress("tracking", context->show_progress);
    return NamingPlace(recording->events.string(), [&] {
      return tracking::TrackEvents(
          recording->reader.get(), recording->camera, context->config.tracker, &context->pool,
          [&](events::Tracks observations) { results.Take(std::move(observations)); },
          [&](double done) { progress.Update(done); },
          draw ? [&](const tracking::TrackingView& view) { drawing.Observe(view); }
               : std::function<void(const tracking::TrackingView&)>{});
    });
  });
  const auto& frames = outcome.result.frames;
  outcome.lifetimes = results.Lifetimes(frames);
  outcome.observations = results.observations();
  context->record.Time("write_tracks", [&] {
    results.Commit();
    report::WriteLifetimes(context->options.out / "lifetime.csv", outcome.lifetimes);
    WriteText(context->options.out / "tables" / "lifetime.tex",
              report::LifetimeTable(SequenceName(recording->events), outcome.lifetimes));
    if (!context->options.no_plots) {
      DrawTrackFigures(context->options.out / "plots", outcome.lifetimes, results.Live(frames));
    }
  });
  context->record.manifest.recorded_s = ToSeconds(frames.back() - frames.front());
  context->record.AddCount("threads", static_cast<std::size_t>(context->pool.size()));
  context->record.AddCount("events", outcome.result.events);
  context->record.AddCount("event_frames", frames.size());
  context->record.AddCount("event_key_frames", outcome.result.key_frames);
  context->record.AddCount("tracks",
                           static_cast<std::size_t>(outcome.lifetimes.tracks + outcome.lifetimes.tracks_too_short));
  context->record.AddCount("track_observations", outcome.observations);
  return outcome;
}

std::vector<std::string> OdometryResultNames() { return {"trajectory.txt", "pose_covariance.csv", "map.ply"}; }

void RemoveOdometryResults(const std::filesystem::path& folder) {
  RemoveResults(folder, R"(manifest\.json|trajectory\.txt|pose_covariance\.csv|map\.ply)");
}

odometry::OdometryResult RunOdometryStage(StageContext* context, const events::Tracks& tracks,
                                          const std::filesystem::path& source, const geometry::Camera& camera) {
  odometry::OdometryResult result = context->record.Time("odometry", [&] {
    std::optional<Progress> progress;
    std::optional<odometry::OdometryStage> shown;
    return NamingPlace(source.string(), [&] {
      return odometry::RunOdometry(tracks, camera, context->config.odometry, context->pool.size(),
                                   [&](odometry::OdometryStage stage, double done) {
                                     if (shown != stage) {
                                       progress.emplace(
                                           stage == odometry::OdometryStage::kFrames ? "odometry" : "refining",
                                           context->show_progress);
                                     }
                                     shown = stage;
                                     progress->Update(done);
                                   });
    });
  });
  for (const TimeNs t : result.lost) spdlog::debug("no pose at {} s", FormatTime(t));
  for (std::size_t i = 1; i < result.bootstraps.size(); ++i) {
    spdlog::warn("tracking was lost; started anew at {} s", FormatTime(result.bootstraps[i]));
    context->record.manifest.rebootstraps.push_back(result.bootstraps[i]);
  }
  context->record.Time("write_trajectory", [&] {
    io::WriteTum(context->options.out / "trajectory.txt", result.trajectory);
    if (!result.covariances.empty()) {
      io::WritePoseCovariances(context->options.out / "pose_covariance.csv", result.covariances);
    }
    odometry::WriteMap(result.points, context->options.out / "map.ply");
  });
  context->record.AddCount("frames", static_cast<std::size_t>(result.frames));
  context->record.AddCount("key_frames", static_cast<std::size_t>(result.key_frames));
  context->record.AddCount("poses", result.trajectory.size());
  context->record.AddCount("frames_lost", result.lost.size());
  context->record.AddCount("map_points", result.points.size());
  context->record.manifest.scale = result.ground && result.ground->metric ? "ground" : "arbitrary";
  if (result.ground) context->record.AddCount("ground_tracks", result.ground->tracks);
  return result;
}

std::string FormatTracking(const TrackingOutcome& outcome) {
  const auto frames = std::max<std::size_t>(1, outcome.result.frames.size());
  return Format("tracking   %zu events, %zu event frames, %.0f live features\n", outcome.result.events,
                outcome.result.frames.size(), static_cast<double>(outcome.observations) / static_cast<double>(frames)) +
         report::FormatLifetimes(outcome.lifetimes);
}

std::string FormatOdometry(const odometry::OdometryResult& result) {
  return Format("odometry   %zu poses of %d frames, %d key frames, %zu points, started anew %zu times\n",
                result.trajectory.size(), result.frames, result.key_frames, result.points.size(),
                result.bootstraps.empty() ? std::size_t{0} : result.bootstraps.size() - 1) +
         (result.ground ? FormatGroundScale(*result.ground) : "");
}

std::string FormatSpeed(const report::Manifest& manifest, int threads) {
  const double recorded = manifest.recorded_s.value_or(0.0);
  const double factor = report::RealTimeFactor(manifest).value_or(0.0);
  return Format("speed      %.1f s of events in %.1f s on %d threads: %.1f x real time\n", recorded,
                factor > 0.0 ? recorded / factor : 0.0, threads, factor);
}

}  // namespace evo::app
