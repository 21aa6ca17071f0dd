#include "app/simulation/preview_output.hpp"

#include <fmt/format.h>

#include <vector>

#include "evo/report/draw.hpp"
#include "evo/report/png.hpp"

namespace evo::app {

namespace {

constexpr int kZoom = 2;                  // px of the drawing a sensor pixel
constexpr TimeNs kExposure = 20'000'000;  // ns of events before an image

report::Canvas DrawImage(const events::GreyImage& image) {
  report::Canvas canvas(kZoom * image.width, kZoom * image.height, {});
  for (int y = 0; y < canvas.height; ++y) {
    for (int x = 0; x < canvas.width; ++x) {
      const std::uint8_t grey = image.grey[static_cast<std::size_t>(y / kZoom * image.width + x / kZoom)];
      canvas.Set(x, y, {grey, grey, grey});
    }
  }
  return canvas;
}

/// The events in [from, to).
events::EventColumns EventsBetween(const events::EventColumns& events, TimeNs from, TimeNs to) {
  events::EventColumns part;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events.t[i] < from || events.t[i] >= to) continue;
    part.push_back(events.t[i], events.x[i], events.y[i], events.polarity[i]);
  }
  return part;
}

}  // namespace

void PreviewOutput::OnEvents(const events::EventColumns& events) {
  output_->OnEvents(events);
  if (events.empty()) return;
  recent_ = EventsBetween(recent_, events.t.front() - kExposure, events.t.front());
  for (std::size_t i = 0; i < events.size(); ++i) {
    recent_.push_back(events.t[i], events.x[i], events.y[i], events.polarity[i]);
  }
}

void PreviewOutput::OnImage(TimeNs t, const events::GreyImage& image, std::size_t events_before) {
  output_->OnImage(t, image, events_before);
  if (t < next_) return;
  next_ += every_;
  const events::EventColumns drawn = EventsBetween(recent_, t - kExposure, t);
  const std::vector<report::Canvas> panels{DrawImage(image),
                                           report::DrawEvents(drawn, image.width, image.height, kZoom)};
  report::WritePng(folder_ / fmt::format("frame_{:08.3f}s.png", ToSeconds(t)),
                   report::ComposeGrid(panels, 2, 2 * kZoom));
}

}  // namespace evo::app
