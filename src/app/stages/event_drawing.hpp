#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "evo/report/draw.hpp"
#include "evo/tracking/track_events.hpp"

namespace evo::app {

/// The times at which event frames are drawn.
struct DrawingSchedule {
  TimeNs first = 0;             ///< stamp from which the first drawing starts
  std::optional<TimeNs> every;  ///< interval of further drawings; empty: one drawing
};

/// Draws event frames with their tracks, as the figures of D. Zhu et al. do. At each time of the schedule it draws four
/// consecutive frames, each as frame_SECONDS.png and all as one labelled sheet, four_frames_SECONDS.png with the time
/// of its first frame; seconds count from `start`. A sheet needs all four frames. A feature keeps its colour. A drawing
/// due during another one follows it.
class EventDrawing {
 public:
  /// `start` is the stamp of the recording's first event.
  EventDrawing(std::filesystem::path folder, TimeNs start, DrawingSchedule schedule)
      : folder_(std::move(folder)), start_(start), schedule_(schedule), next_(schedule.first) {}

  /// Adds the next event frame. Throws Error (kOutput).
  void Add(const tracking::TrackingView& view);

 private:
  void WriteSheet();

  std::filesystem::path folder_;
  TimeNs start_;
  DrawingSchedule schedule_;
  std::optional<TimeNs> next_;          ///< stamp of the next drawing; empty after the last one
  std::vector<report::Canvas> frames_;  ///< frames of the present drawing
  std::vector<TimeNs> stamps_;
};

/// Removes the images of an earlier EventDrawing from `folder`, which need not exist, and nothing else.
void RemoveDrawings(const std::filesystem::path& folder);

}  // namespace evo::app
