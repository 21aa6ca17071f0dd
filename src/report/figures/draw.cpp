#include "evo/report/draw.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

namespace evo::report {

namespace {

constexpr Color kWhite{255, 255, 255};
constexpr Color kBlack{0, 0, 0};
constexpr Color kGrey{150, 150, 150};
constexpr Color kPositiveEvent{240, 150, 140};  // pale, so that tracks stand out
constexpr Color kNegativeEvent{150, 185, 235};

constexpr int kFractionBits = 4;  // of OpenCV's fixed-point coordinates

std::size_t Offset(const Canvas& canvas, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(canvas.width) + static_cast<std::size_t>(x));
}

/// The canvas as an OpenCV image that shares its pixels.
cv::Mat AsMat(Canvas* canvas) { return {canvas->height, canvas->width, CV_8UC3, canvas->rgb.data()}; }

cv::Scalar ToScalar(Color color) { return {double(color.red), double(color.green), double(color.blue)}; }

int ToFixed(double value) { return static_cast<int>(std::lround(value * (1 << kFractionBits))); }

cv::Point ToFixed(const cv::Point2d& point) { return {ToFixed(point.x), ToFixed(point.y)}; }

/// The centre of a sensor pixel on a canvas with zoom x zoom px for each.
cv::Point2d ToCanvas(double x, double y, int zoom) { return {(x + 0.5) * zoom - 0.5, (y + 0.5) * zoom - 0.5}; }

/// A tail of canvas positions for each track alive at `t`, newest first.
std::map<std::int64_t, std::vector<cv::Point2d>> CollectTails(const events::Tracks& tracks, TimeNs t,
                                                              const TrackDrawing& drawing) {
  std::map<std::int64_t, std::vector<cv::Point2d>> tails;
  const auto max_length = static_cast<std::size_t>(drawing.tail) + 1;
  std::size_t incomplete = 0;
  auto observation = std::ranges::upper_bound(tracks, t, {}, &events::TrackObservation::t);
  while (observation != tracks.begin()) {
    --observation;
    const bool alive = t - observation->t <= drawing.max_age;
    if (!alive && incomplete == 0) break;
    auto tail = tails.find(observation->id);
    if (tail == tails.end()) {
      if (!alive) continue;
      tail = tails.emplace(observation->id, std::vector<cv::Point2d>()).first;
      ++incomplete;
    }
    if (tail->second.size() == max_length) continue;
    tail->second.push_back(ToCanvas(observation->x, observation->y, drawing.zoom));
    if (tail->second.size() == max_length) --incomplete;
  }
  return tails;
}

void DrawTail(cv::Mat* image, const std::vector<cv::Point2d>& tail, Color color, int thickness, double radius) {
  for (std::size_t i = 1; i < tail.size(); ++i) {
    cv::line(*image, ToFixed(tail[i - 1]), ToFixed(tail[i]), ToScalar(color), thickness, cv::LINE_AA, kFractionBits);
  }
  cv::circle(*image, ToFixed(tail.front()), ToFixed(radius), ToScalar(color), cv::FILLED, cv::LINE_AA, kFractionBits);
}

}  // namespace

Canvas::Canvas(int columns, int rows, Color background) : width(columns), height(rows) {
  rgb.resize(3 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  AsMat(this).setTo(ToScalar(background));
}

Color Canvas::At(int x, int y) const {
  const std::size_t i = Offset(*this, x, y);
  return {rgb[i], rgb[i + 1], rgb[i + 2]};
}

void Canvas::Set(int x, int y, Color color) {
  const std::size_t i = Offset(*this, x, y);
  rgb[i] = color.red;
  rgb[i + 1] = color.green;
  rgb[i + 2] = color.blue;
}

void DrawLabel(Canvas* canvas, int x, int y, const std::string& text, int height) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  const int thickness = std::max(1, height / 10);
  const double scale = cv::getFontScaleFromHeight(kFont, height, thickness);
  const cv::Size size = cv::getTextSize(text, kFont, scale, thickness, nullptr);
  const int margin = height / 2;
  cv::Mat image = AsMat(canvas);
  cv::rectangle(image, {x, y, size.width + 2 * margin, size.height + 2 * margin}, ToScalar(kWhite), cv::FILLED);
  cv::putText(image, text, {x + margin, y + margin + size.height}, kFont, scale, ToScalar(kBlack), thickness,
              cv::LINE_AA);
}

Canvas ComposeGrid(std::span<const Canvas> panels, int columns, int gap) {
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  const int width = panels.front().width;
  const int height = panels.front().height;
  Canvas grid(columns * width + (columns - 1) * gap, rows * height + (rows - 1) * gap, kGrey);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const int left = static_cast<int>(i) % columns * (width + gap);
    const int top = static_cast<int>(i) / columns * (height + gap);
    for (int row = 0; row < height; ++row) {
      const auto from = panels[i].rgb.begin() + static_cast<std::ptrdiff_t>(Offset(panels[i], 0, row));
      std::copy_n(from, 3 * width, grid.rgb.begin() + static_cast<std::ptrdiff_t>(Offset(grid, left, top + row)));
    }
  }
  return grid;
}

Canvas DrawEvents(const events::EventColumns& events, int width, int height, int zoom) {
  Canvas canvas(width * zoom, height * zoom, kWhite);
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events.x[i] >= width || events.y[i] >= height) continue;
    const Color color = events.polarity[i] > 0 ? kPositiveEvent : kNegativeEvent;
    for (int row = 0; row < zoom; ++row) {
      for (int column = 0; column < zoom; ++column) {
        canvas.Set(events.x[i] * zoom + column, events.y[i] * zoom + row, color);
      }
    }
  }
  return canvas;
}

Color TrackColor(std::int64_t id) {
  // Steps of the golden ratio around the circle of hues keep the colours of successive ids far apart.
  constexpr double kGoldenRatio = 0.6180339887498949;
  constexpr double kMaxChannel = 200.0;  // darker than full, for contrast on white
  const double hue = 6.0 * std::fmod(static_cast<double>(id) * kGoldenRatio, 1.0);
  const auto channel = [&](double shift) {
    const double h = std::fmod(hue + shift, 6.0);
    return static_cast<std::uint8_t>(std::lround(kMaxChannel * std::clamp(std::abs(h - 3.0) - 1.0, 0.0, 1.0)));
  };
  return {channel(0.0), channel(4.0), channel(2.0)};
}

void DrawTracks(Canvas* canvas, const events::Tracks& tracks, TimeNs t, const TrackDrawing& drawing) {
  const int thickness = (drawing.zoom + 2) / 2;
  const double radius = 1.0 + 0.5 * drawing.zoom;
  const int outline = (drawing.zoom + 1) / 2;
  const auto tails = CollectTails(tracks, t, drawing);
  cv::Mat image = AsMat(canvas);
  // All outlines come first, so that no outline covers another track.
  for (const auto& [id, tail] : tails) DrawTail(&image, tail, kWhite, thickness + outline, radius + 0.5 * outline);
  for (const auto& [id, tail] : tails) DrawTail(&image, tail, TrackColor(id), thickness, radius);
}

}  // namespace evo::report
