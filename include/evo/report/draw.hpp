#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"
#include "evo/events/tracks.hpp"

namespace evo::report {

struct Color {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  bool operator==(const Color&) const = default;
};

/// An RGB image, row by row from the upper left; integer coordinates are pixel centres.
struct Canvas {
  int width = 0;                  ///< px
  int height = 0;                 ///< px
  std::vector<std::uint8_t> rgb;  ///< 3 * width * height

  Canvas(int columns, int rows, Color background);
  Color At(int x, int y) const;
  void Set(int x, int y, Color color);
};

/// Draws black text on a white box with its upper left corner at (x, y); `height` is that of a capital (px).
void DrawLabel(Canvas* canvas, int x, int y, const std::string& text, int height);

/// Arranges canvases of one size row by row in a grid of `columns`, with grey gaps of `gap` px.
Canvas ComposeGrid(std::span<const Canvas> panels, int columns, int gap);

/// Draws events on white, positive ones pale red, negative ones pale blue, each sensor pixel as `zoom` x `zoom` px. The
/// last event of a pixel wins; events off the sensor of `width` x `height` px are ignored.
Canvas DrawEvents(const events::EventColumns& events, int width, int height, int zoom = 1);

/// The colour of a track, far from those of the next ids.
Color TrackColor(std::int64_t id);

struct TrackDrawing {
  int tail = 10;                ///< earlier positions to draw
  TimeNs max_age = 50'000'000;  ///< tracks without a more recent observation are not drawn (ns)
  int zoom = 1;                 ///< as for DrawEvents
};

/// Draws the tracks at time `t`, each as a dot at its latest position with a tail of earlier ones, outlined in white.
void DrawTracks(Canvas* canvas, const events::Tracks& tracks, TimeNs t, const TrackDrawing& drawing);

}  // namespace evo::report
