#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "evo/report/draw.hpp"
#include "evo/tracking/track_events.hpp"

namespace evo::app {

/// When event frames are drawn.
struct DrawingSchedule {
  TimeNs first = 0;             ///< the first drawing begins with the first event frame from here on
  std::optional<TimeNs> every;  ///< and the others follow at this interval; empty: there is only one
};

/// Draws event frames with their tracks, while they pass by, as the paper's figures show them: at each time of the
/// schedule four consecutive frames, each as frame_SECONDS.png and all as one labelled sheet, four_frames_SECONDS.png
/// of its first frame; seconds since `start`. Where the frames end before there are four, there is no sheet. A feature
/// has the same colour in all of them. A drawing that is due during another one follows it.
class EventDrawing {
 public:
  /// `start` is the stamp of the recording's first event.
  EventDrawing(std::filesystem::path folder, TimeNs start, DrawingSchedule schedule)
      : folder_(std::move(folder)), start_(start), schedule_(schedule), next_(schedule.first) {}

  /// To be called with every event frame in turn. Throws Error (kOutput).
  void Observe(const tracking::TrackingView& view);

 private:
  void WriteSheet();

  std::filesystem::path folder_;
  TimeNs start_;
  DrawingSchedule schedule_;
  std::optional<TimeNs> next_;          ///< when the next drawing is due; empty once all are done
  std::vector<report::Canvas> frames_;  ///< of the drawing under way
  std::vector<TimeNs> stamps_;
};

/// Removes the images that EventDrawing has left in `folder`, which need not exist, and nothing else: those of an
/// earlier run would not fit to what is about to replace it.
void RemoveDrawings(const std::filesystem::path& folder);

}  // namespace evo::app
