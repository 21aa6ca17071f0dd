#include "app/stages/tracking_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>

#include "app/run/error_context.hpp"
#include "app/run/output_folder.hpp"
#include "app/stages/diagnosis.hpp"
#include "app/stages/event_drawing.hpp"
#include "app/stages/track_results.hpp"
#include "evo/core/error.hpp"
#include "evo/core/output_file.hpp"
#include "evo/core/progress.hpp"
#include "evo/events/flicker.hpp"
#include "evo/events/grey_image.hpp"
#include "evo/io/pixel_files.hpp"
#include "evo/report/evaluation_tables.hpp"
#include "evo/report/figures.hpp"
#include "evo/report/latex_tables.hpp"
#include "evo/report/png.hpp"
#include "evo/report/terminal_summary.hpp"

namespace evo::app {

namespace {

namespace fs = std::filesystem;

/// The stamp at which tracking ends, also if --to is beyond the end of the recording.
TimeNs EndOfInterval(const Recording& recording) {
  if (!recording.interval.to) return recording.reader->last_stamp();
  const TimeNs to = recording.reader->first_stamp() + *recording.interval.to;
  try {
    return std::min(to, recording.reader->last_stamp());
  } catch (const Error&) {
    return to;  // damage beyond the interval does not concern this run
  }
}

/// Four frames in the middle of the interval, or four every `draw_every_s` seconds from its start on.
DrawingSchedule ScheduleDrawings(double draw_every_s, double frame_interval_s, const Recording& recording) {
  const TimeNs from = recording.reader->first_stamp() + recording.interval.from;
  if (draw_every_s > 0.0) return {from, FromSeconds(draw_every_s)};
  return {from + (EndOfInterval(recording) - from) / 2 - 2 * FromSeconds(frame_interval_s), std::nullopt};
}

void DrawTrackFigures(const fs::path& folder, const evaluation::LifetimeStatistics& lifetimes,
                      std::span<const report::LiveFeatures> live) {
  report::Gnuplot gnuplot(folder);
  gnuplot.Draw("lifetime", report::LifetimeFigure("lifetime", lifetimes));
  gnuplot.Draw("lifetime_seconds", report::LifetimeSecondsFigure("lifetime_seconds", lifetimes));
  gnuplot.Draw("live_features", report::LiveFeaturesFigure("live_features", live));
}

/// Tracks the recording into `results` and draws into images/.
tracking::TrackingResult Track(const tracking::TrackerOptions& options, Recording* recording, StageRun* run,
                               TrackResults* results) {
  const bool draw = run->results.draw_every_s > 0.0 || !run->results.no_plots;
  EventDrawing drawing(
      run->results.out / "images", recording->reader->first_stamp(),
      draw ? ScheduleDrawings(run->results.draw_every_s, options.frame_interval_s, *recording) : DrawingSchedule());
  Progress progress("tracking", run->show_progress);
  return WithErrorContext(recording->events.string(), [&] {
    return tracking::TrackEvents(
        recording->reader.get(), recording->camera, options, &run->pool,
        [&](events::Tracks observations) { results->Add(std::move(observations)); },
        [&](double done) { progress.Update(done); },
        draw ? [&](const tracking::TrackingView& view) { drawing.Add(view); }
             : std::function<void(const tracking::TrackingView&)>{});
  });
}

void WriteLifetimes(const StageRun& run, const std::string& sequence, const evaluation::LifetimeStatistics& lifetimes) {
  report::WriteLifetimes(run.results.out / "lifetime.csv", lifetimes);
  WriteText(run.results.out / "tables" / "lifetime.tex", report::LifetimeTable(sequence, lifetimes));
}

void RecordCounts(const TrackingOutcome& outcome, StageRun* run) {
  const auto& [result, lifetimes, observations, filters, hot_pixels, mask] = outcome;
  RunRecord& record = run->record;
  record.manifest.recorded_s = ToSeconds(result.frames.back() - result.frames.front());
  record.AddCount("threads", static_cast<std::size_t>(run->pool.size()));
  record.AddCount("events", filters.events);
  record.AddCount("masked_pixels", filters.masked_pixels);
  record.AddCount("masked_events", filters.masked_events);
  record.AddCount("hot_pixels", hot_pixels);
  record.AddCount("hot_events", filters.hot_events);
  record.AddCount("flicker_hz", static_cast<std::size_t>(std::lround(filters.flicker.frequency_hz)));
  record.AddCount("flicker_events", filters.flicker.flicker_events);
  record.AddCount("flicker_replaced_by", filters.flicker.replaced_by);
  record.AddCount("event_frames", result.frames.size());
  record.AddCount("event_key_frames", result.key_frames);
  record.AddCount("tracks", static_cast<std::size_t>(lifetimes.tracks + lifetimes.tracks_too_short));
  record.AddCount("track_observations", observations);
}

std::string FormatFlicker(const events::FlickerStatistics& flicker) {
  if (flicker.flicker_events == 0) return {};
  const auto ratio = [](std::uint64_t part, std::uint64_t all) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(all);
  };
  return fmt::format("flicker    {:.1f} Hz, {:.2f} % of the events, replaced by {:.1f} % of them\n",
                     flicker.frequency_hz, ratio(flicker.flicker_events, flicker.events),
                     ratio(flicker.replaced_by, flicker.flicker_events));
}

/// What the filters left out; empty if nothing.
std::string FormatFilters(const TrackingOutcome& outcome) {
  const events::FilterStatistics& filters = outcome.filters;
  const auto percent = [&](std::uint64_t events) {
    return 100.0 * static_cast<double>(events) / static_cast<double>(std::max<std::uint64_t>(1, filters.events));
  };
  std::string text;
  if (!outcome.auto_mask.empty()) {
    const std::string of_events =
        filters.masked_pixels > 0 ? fmt::format(", {:.2f} % of the events", percent(filters.masked_events)) : "";
    text += fmt::format("mask       auto: {}{}\n", outcome.auto_mask, of_events);
  } else if (filters.masked_pixels > 0) {
    text += fmt::format("mask       {} pixels, {:.2f} % of the events\n", filters.masked_pixels,
                        percent(filters.masked_events));
  }
  if (outcome.hot_pixels > 0) {
    text += fmt::format("hot pixels {}, {:.2f} % of the events\n", outcome.hot_pixels, percent(filters.hot_events));
  }
  return text + FormatFlicker(filters.flicker);
}

/// Black where events are ignored, as --mask reads it.
void SaveMask(const Recording& recording) {
  const int width = recording.camera.width();
  const int height = recording.camera.height();
  events::GreyImage image{width, height, {}};
  image.grey.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255);
  for (std::size_t i = 0; i < recording.masked.size(); ++i) {
    if (recording.masked[i] != 0) image.grey[i] = 0;
  }
  report::WritePng(recording.save_mask, image);
}

}  // namespace

std::vector<std::string> TrackingResultNames() { return {"tracks.txt", "lifetime.csv", "tables/lifetime.tex"}; }

void RemoveTrackingResults(const fs::path& folder) {
  RemoveResults(folder, R"(manifest\.json|tracks\.txt|lifetime\.csv)");
  RemoveResults(folder / "tables", R"(lifetime\.tex)");
  RemovePlots(folder, "lifetime|lifetime_seconds|live_features");
  RemoveDrawings(folder / "images");
}

TrackingOutcome RunTrackingStage(const tracking::TrackerOptions& options, Recording* recording, StageRun* run,
                                 events::Tracks* tracks) {
  TrackResults results(run->results.out / "tracks.txt", {tracking::DescribePositions(options)}, tracks);
  TrackingOutcome outcome;
  outcome.result = run->record.Time("track", [&] { return Track(options, recording, run, &results); });
  outcome.filters = recording->reader->statistics();
  outcome.hot_pixels = recording->reader->hot_pixels().size();
  run->record.manifest.hot_pixels = recording->reader->hot_pixels();
  if (!recording->save_hot_pixels.empty()) {
    io::WriteHotPixels(recording->save_hot_pixels, recording->reader->hot_pixels());
  }
  outcome.auto_mask = recording->auto_mask;
  if (!recording->save_mask.empty()) SaveMask(*recording);
  const auto& frames = outcome.result.frames;
  outcome.lifetimes = results.Lifetimes(frames);
  outcome.observations = results.observations();
  run->record.Time("write_tracks", [&] {
    results.Commit();
    WriteLifetimes(*run, SequenceName(recording->events), outcome.lifetimes);
    if (!run->results.no_plots) {
      DrawTrackFigures(run->results.out / "plots", outcome.lifetimes, results.CountLive(frames));
    }
  });
  RecordCounts(outcome, run);
  run->diagnosis.filters = DiagnoseFilters(outcome.filters, outcome.hot_pixels, recording->camera);
  run->diagnosis.features = DiagnoseFeatures(options, results.CountLive(frames), results.Rest());
  return outcome;
}

std::string FormatTracking(const TrackingOutcome& outcome) {
  const auto frames = std::max<std::size_t>(1, outcome.result.frames.size());
  return FormatFilters(outcome) +
         fmt::format("tracking   {} events, {} event frames, {:.0f} live features\n", outcome.result.events,
                     outcome.result.frames.size(),
                     static_cast<double>(outcome.observations) / static_cast<double>(frames)) +
         report::FormatLifetimes(outcome.lifetimes);
}

}  // namespace evo::app
