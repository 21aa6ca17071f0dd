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

std::size_t Offset(const Canvas& canvas, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(canvas.width) + static_cast<std::size_t>(x));
}

/// Blends `color` wherever `distance(point)` to the middle of a stroke is below `half_width`, with a soft edge of 1 px.
template <typename Distance>
void Stroke(Canvas* canvas, const Eigen::Array2d& low, const Eigen::Array2d& high, double half_width, Color color,
            const Distance& distance) {
  const double margin = half_width + 1.0;
  const int x0 = static_cast<int>(std::max(0.0, std::floor(low.x() - margin)));
  const int y0 = static_cast<int>(std::max(0.0, std::floor(low.y() - margin)));
  const int x1 = static_cast<int>(std::min(canvas->width - 1.0, std::ceil(high.x() + margin)));
  const int y1 = static_cast<int>(std::min(canvas->height - 1.0, std::ceil(high.y() + margin)));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const double opacity = half_width + 0.5 - distance(Eigen::Vector2d(x, y));
      if (opacity > 0.0) canvas->Blend(x, y, color, std::min(1.0, opacity));
    }
  }
}

Color PolarityColor(PolarityColors colors, int polarity) {
  if (colors == PolarityColors::kRedBlue) return polarity > 0 ? Color{240, 150, 140} : Color{150, 185, 235};
  return polarity > 0 ? Color{170, 170, 170} : Color{50, 50, 50};
}

/// The centre of a sensor pixel on a canvas that shows each as zoom x zoom px.
Eigen::Vector2d Zoomed(double x, double y, int zoom) { return {(x + 0.5) * zoom - 0.5, (y + 0.5) * zoom - 0.5}; }

/// Positions up to `t` of the tracks alive then, newest first.
std::map<std::int64_t, std::vector<Eigen::Vector2d>> CollectTails(const events::Tracks& tracks, TimeNs t,
                                                                  const TrackDrawing& drawing) {
  std::map<std::int64_t, std::vector<Eigen::Vector2d>> tails;
  const auto longest = static_cast<std::size_t>(drawing.tail) + 1;
  std::size_t unfinished = 0;
  auto observation = std::ranges::upper_bound(tracks, t, {}, &events::TrackObservation::t);
  while (observation != tracks.begin()) {
    --observation;
    const bool alive = t - observation->t <= drawing.alive;
    if (!alive && unfinished == 0) break;
    auto tail = tails.find(observation->id);
    if (tail == tails.end()) {
      if (!alive) continue;
      tail = tails.emplace(observation->id, std::vector<Eigen::Vector2d>()).first;
      ++unfinished;
    }
    if (tail->second.size() == longest) continue;
    tail->second.push_back(Zoomed(observation->x, observation->y, drawing.zoom));
    if (tail->second.size() == longest) --unfinished;
  }
  return tails;
}

}  // namespace

Canvas::Canvas(int columns, int rows, Color background) : width(columns), height(rows) {
  rgb.resize(3 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    rgb[i] = background.red;
    rgb[i + 1] = background.green;
    rgb[i + 2] = background.blue;
  }
}

Color Canvas::At(int x, int y) const {
  const std::size_t i = Offset(*this, x, y);
  return {rgb[i], rgb[i + 1], rgb[i + 2]};
}

void Canvas::Blend(int x, int y, Color color, double opacity) {
  if (x < 0 || y < 0 || x >= width || y >= height) return;
  const std::size_t i = Offset(*this, x, y);
  const auto mix = [&](std::uint8_t under, std::uint8_t over) {
    return static_cast<std::uint8_t>(std::lround((1.0 - opacity) * under + opacity * over));
  };
  rgb[i] = mix(rgb[i], color.red);
  rgb[i + 1] = mix(rgb[i + 1], color.green);
  rgb[i + 2] = mix(rgb[i + 2], color.blue);
}

void DrawLine(Canvas* canvas, const Eigen::Vector2d& a, const Eigen::Vector2d& b, Color color, double thickness) {
  const Eigen::Vector2d along = b - a;
  const double length2 = along.squaredNorm();
  Stroke(canvas, a.array().min(b.array()), a.array().max(b.array()), 0.5 * thickness, color,
         [&](const Eigen::Vector2d& point) {
           const double s = length2 > 0.0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
           return (point - a - s * along).norm();
         });
}

void DrawCircle(Canvas* canvas, const Eigen::Vector2d& center, double radius, Color color, double thickness) {
  Stroke(canvas, center.array() - radius, center.array() + radius, 0.5 * thickness, color,
         [&](const Eigen::Vector2d& point) { return std::abs((point - center).norm() - radius); });
}

void DrawDisc(Canvas* canvas, const Eigen::Vector2d& center, double radius, Color color) {
  Stroke(canvas, center.array(), center.array(), radius, color,
         [&](const Eigen::Vector2d& point) { return (point - center).norm(); });
}

void DrawLabel(Canvas* canvas, int x, int y, const std::string& text, int height) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  const int thickness = std::max(1, height / 10);
  const double scale = cv::getFontScaleFromHeight(kFont, height, thickness);
  const cv::Size size = cv::getTextSize(text, kFont, scale, thickness, nullptr);
  const int margin = height / 2;
  cv::Mat image(canvas->height, canvas->width, CV_8UC3, canvas->rgb.data());
  cv::rectangle(image, {x, y, size.width + 2 * margin, size.height + 2 * margin},
                cv::Scalar(kWhite.red, kWhite.green, kWhite.blue), cv::FILLED);
  cv::putText(image, text, {x + margin, y + margin + size.height}, kFont, scale,
              cv::Scalar(kBlack.red, kBlack.green, kBlack.blue), thickness, cv::LINE_AA);
}

Canvas Sheet(std::span<const Canvas> panels, int columns, int gap) {
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  const int width = panels.front().width;
  const int height = panels.front().height;
  Canvas sheet(columns * width + (columns - 1) * gap, rows * height + (rows - 1) * gap, kGrey);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const int left = static_cast<int>(i) % columns * (width + gap);
    const int top = static_cast<int>(i) / columns * (height + gap);
    for (int row = 0; row < height; ++row) {
      const auto from = panels[i].rgb.begin() + static_cast<std::ptrdiff_t>(Offset(panels[i], 0, row));
      std::copy_n(from, 3 * width, sheet.rgb.begin() + static_cast<std::ptrdiff_t>(Offset(sheet, left, top + row)));
    }
  }
  return sheet;
}

Canvas DrawEvents(const events::EventColumns& events, int width, int height, PolarityColors colors, int zoom) {
  Canvas canvas(width * zoom, height * zoom, kWhite);
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events.x[i] >= width || events.y[i] >= height) continue;
    const Color color = PolarityColor(colors, events.polarity[i]);
    for (int row = 0; row < zoom; ++row) {
      for (int column = 0; column < zoom; ++column) {
        canvas.Blend(events.x[i] * zoom + column, events.y[i] * zoom + row, color);
      }
    }
  }
  return canvas;
}

Color TrackColor(std::int64_t id) {
  // Steps of the golden ratio around the circle of hues keep the colours of successive ids far apart.
  constexpr double kGolden = 0.6180339887498949;
  const double hue = 6.0 * std::fmod(static_cast<double>(id) * kGolden, 1.0);
  const auto channel = [&](double shift) {
    const double h = std::fmod(hue + shift, 6.0);
    const double share = std::clamp(std::abs(h - 3.0) - 1.0, 0.0, 1.0);
    return static_cast<std::uint8_t>(std::lround(200.0 * share));
  };
  return {channel(0.0), channel(4.0), channel(2.0)};
}

void DrawTracks(Canvas* canvas, const events::Tracks& tracks, TimeNs t, const TrackDrawing& drawing) {
  const double zoom = drawing.zoom;
  const auto tails = CollectTails(tracks, t, drawing);
  // All outlines first, then all tracks: none hides another.
  for (const double outline : {0.5 * zoom, 0.0}) {
    for (const auto& [id, tail] : tails) {
      const Color color = outline > 0.0 ? kWhite : TrackColor(id);
      for (std::size_t i = 1; i < tail.size(); ++i) {
        DrawLine(canvas, tail[i - 1], tail[i], color, 0.5 + 0.5 * zoom + outline);
      }
      DrawDisc(canvas, tail.front(), 1.0 + 0.5 * zoom + 0.5 * outline, color);
    }
  }
}

}  // namespace evo::report
