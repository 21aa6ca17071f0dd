#pragma once

#include <Eigen/Core>
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

/// An RGB image, row by row from the top left; integer coordinates are pixel centres.
struct Canvas {
  int width = 0;                  ///< px
  int height = 0;                 ///< px
  std::vector<std::uint8_t> rgb;  ///< 3 * width * height

  Canvas(int columns, int rows, Color background);
  Color At(int x, int y) const;
  /// Lays `color` over a pixel with the given share in [0, 1]; pixels off the canvas are ignored.
  void Blend(int x, int y, Color color, double opacity = 1.0);
};

/// Anti-aliased straight line from `a` to `b`, `thickness` px wide, with round ends.
void DrawLine(Canvas* canvas, const Eigen::Vector2d& a, const Eigen::Vector2d& b, Color color, double thickness = 1.0);
/// Anti-aliased circle line and disc; `radius` in px, to the middle of the line and to the edge of the disc.
void DrawCircle(Canvas* canvas, const Eigen::Vector2d& center, double radius, Color color, double thickness = 1.0);
void DrawDisc(Canvas* canvas, const Eigen::Vector2d& center, double radius, Color color);

/// Black text on a white box whose upper left corner is (x, y); `height` of a capital in px.
void DrawLabel(Canvas* canvas, int x, int y, const std::string& text, int height);

/// Equally large canvases row by row from the upper left, `columns` beside each other, with grey gaps of `gap` px.
Canvas Sheet(std::span<const Canvas> panels, int columns, int gap);

enum class PolarityColors {
  kRedBlue,    ///< brighter red, darker blue, both pale, so that tracks stand out
  kLightDark,  ///< brighter light grey, darker dark grey, for print
};

/// The events on white, each sensor pixel `zoom` x `zoom` px of the image; the last event of a pixel wins.
/// Events off the sensor of `width` x `height` px are ignored.
Canvas DrawEvents(const events::EventColumns& events, int width, int height, PolarityColors colors, int zoom = 1);

/// A colour that stays with a track, well apart from those of the next ids.
Color TrackColor(std::int64_t id);

struct TrackDrawing {
  int tail = 10;              ///< positions shown behind the present one
  TimeNs alive = 50'000'000;  ///< a track last seen longer ago is over and not shown
  int zoom = 1;               ///< as for DrawEvents
};

/// The tracks alive at `t`, each a dot at its last position up to `t` with its tail of earlier ones, outlined in white.
void DrawTracks(Canvas* canvas, const events::Tracks& tracks, TimeNs t, const TrackDrawing& drawing);

}  // namespace evo::report
