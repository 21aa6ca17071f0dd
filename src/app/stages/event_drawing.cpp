#include "app/stages/event_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/run/output_folder.hpp"
#include "evo/report/png.hpp"

namespace evo::app {

namespace {

namespace fs = std::filesystem;

constexpr int kZoom = 3;                  // px of the drawing a sensor pixel
constexpr TimeNs kExposure = 10'000'000;  // ns; shows edges about as sharp as the tracker's windows
constexpr std::size_t kFrames = 4;
constexpr int kColumns = 2;
constexpr int kGap = 2 * kZoom;          // px between the frames of a sheet
constexpr int kLabelHeight = 8 * kZoom;  // px

report::Canvas DrawFrame(const tracking::TrackingView& view) {
  events::EventColumns events;
  view.history.ForEachBetween(
      view.t - kExposure / 2, view.t + kExposure / 2, [&](int x, int y, TimeNs t, std::int8_t polarity) {
        events.push_back(t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), polarity);
      });
  report::Canvas canvas = report::DrawEvents(events, view.history.width(), view.history.height(), kZoom);
  report::TrackDrawing drawing;
  drawing.zoom = kZoom;
  drawing.max_age = 0;
  report::DrawTracks(&canvas, view.tracks, view.t, drawing);
  return canvas;
}

}  // namespace

void EventDrawing::Add(const tracking::TrackingView& view) {
  if (frames_.empty()) {
    if (!next_ || view.t < *next_) return;
    next_ = schedule_.every ? std::optional(std::max(*next_ + *schedule_.every, view.t)) : std::nullopt;
  }
  frames_.push_back(DrawFrame(view));
  stamps_.push_back(view.t);
  report::WritePng(folder_ / fmt::format("frame_{:08.3f}s.png", ToSeconds(view.t - start_)), frames_.back());
  if (frames_.size() == kFrames) WriteSheet();
}

void EventDrawing::WriteSheet() {
  for (std::size_t i = 0; i < kFrames; ++i) {
    report::DrawLabel(&frames_[i], 0, 0, fmt::format("t = {:.3f} s", ToSeconds(stamps_[i] - start_)), kLabelHeight);
  }
  report::WritePng(folder_ / fmt::format("four_frames_{:08.3f}s.png", ToSeconds(stamps_.front() - start_)),
                   report::ComposeGrid(frames_, kColumns, kGap));
  frames_.clear();
  stamps_.clear();
}

void RemoveDrawings(const fs::path& folder) { RemoveResults(folder, R"((four_frames|frame)_\d{4,}\.\d{3}s\.png)"); }

}  // namespace evo::app
