#include <algorithm>
#include <cmath>

#include "simulation/world/painter.hpp"
#include "simulation/world/textures.hpp"

namespace evo::simulation {

namespace {

constexpr double kMarking = 0.75;  // reflectance of lane markings

int Between(Random& random, int low, int high) { return low + random.Index(high - low); }

/// Repaired patches with a seam of tar.
void PaintPatches(Random& random, Painter* painter, int count) {
  for (int i = 0; i < count; ++i) {
    const int width = Between(random, 60, 260);
    const int length = Between(random, 60, 400);
    const int x = random.Index(painter->width());
    const int y = random.Index(painter->height());
    painter->Rectangle(x, y, width, length, random.Uniform(0.12, 0.34));
    painter->Outline(x, y, width, length, Between(random, 2, 5), 0.07);
  }
}

void PaintManhole(Random& random, Painter* painter) {
  const double x = random.Uniform(0.2, 0.8) * painter->width();
  const double y = random.Uniform() * painter->height();
  const double radius = random.Uniform(24.0, 34.0);
  painter->Ellipse(x, y, radius + 5.0, radius + 5.0, 0.3);
  painter->Ellipse(x, y, radius, radius, 0.1);
  for (int row = -2; row <= 2; ++row) {
    for (int column = -2; column <= 2; ++column) {
      painter->Ellipse(x + 9.0 * column, y + 9.0 * row, 3.0, 3.0, 0.3);
    }
  }
}

void PaintCracks(Random& random, Painter* painter) {
  const int area = painter->width() * painter->height();
  for (int i = 0; i < area / 60'000; ++i) {
    const double x = random.Uniform() * painter->width();
    const double y = random.Uniform() * painter->height();
    if (random.Chance(0.3)) {
      painter->Crack(random, x, y, random.Uniform(100.0, 500.0), 5.0, 0.06);  // filled with tar
    } else {
      painter->Crack(random, x, y, random.Uniform(60.0, 400.0), 1.6, 0.08);
    }
  }
}

Painter MakeAsphaltPainter(Random& random, int length, double contrast) {
  Painter painter(kRoadWidthTexels, length, random.Uniform(0.22, 0.28));
  const int area = kRoadWidthTexels * length;
  PaintPatches(random, &painter, std::max(1, area / 160'000));
  PaintCracks(random, &painter);
  for (int i = 0; i < std::max(1, area / 800'000); ++i) PaintManhole(random, &painter);
  if (contrast != 1.0) painter.ScaleContrast(contrast);
  return painter;
}

/// Stones, dirt and wear over everything including the markings.
Texture Weather(Random& random, Painter* painter, double contrast) {
  painter->Noise(random, 256, 256, 3, 0.015 * contrast, 0.8);
  painter->Noise(random, 32, 64, 4, 0.015 * contrast, 0.8);
  painter->Grain(random, 0.02 * contrast);
  const int stains = static_cast<int>(contrast * painter->width() * painter->height() / 8000.0);
  for (int i = 0; i < stains; ++i) {  // oil, leaves, chewing gum
    const double radius = random.Uniform(1.0, 4.5);
    painter->Ellipse(random.Uniform() * painter->width(), random.Uniform() * painter->height(), radius,
                     radius * random.Uniform(0.5, 1.0), random.Chance(0.6) ? 0.1 : random.Uniform(0.3, 0.5));
  }
  return painter->Finish();
}

/// A marking that is worn in places.
void MarkRectangle(Random& random, Painter* painter, int x, int y, int width, int length) {
  painter->Rectangle(x, y, width, length, kMarking);
  for (int i = 0; i < width * length / 150; ++i) {
    painter->Ellipse(x + random.Uniform() * width, y + random.Uniform() * length, random.Uniform(0.8, 3.0),
                     random.Uniform(0.8, 4.0), 0.3);
  }
}

}  // namespace

Texture PaintAsphalt(Random& random, int length, double contrast) {
  Painter painter = MakeAsphaltPainter(random, length, contrast);
  return Weather(random, &painter, contrast);
}

Texture PaintLanes(Random& random, const CarriagewayLayout& layout, int length, double contrast) {
  Painter painter = MakeAsphaltPainter(random, length, contrast);
  const double texels_per_m = kRoadWidthTexels / layout.width();
  const auto texels = [&](double metres) { return static_cast<int>(std::lround(metres * texels_per_m)); };
  const int line = std::max(2, texels(0.14));
  const int dashes = std::max(1, static_cast<int>(std::lround(length / texels_per_m / 7.5)));
  for (int i = 0; i < dashes; ++i) {
    MarkRectangle(random, &painter, (kRoadWidthTexels - line) / 2, i * length / dashes, line, texels(3.0));
  }
  const int bays = std::max(1, static_cast<int>(std::lround(length / texels_per_m / 5.7)));
  const int park = texels(layout.parking_m);
  for (const int x : {park, kRoadWidthTexels - park - line}) MarkRectangle(random, &painter, x, 0, line, length);
  for (int i = 0; i < bays && layout.bays && park > 2 * line; ++i) {
    MarkRectangle(random, &painter, 0, i * length / bays, park, line);
    MarkRectangle(random, &painter, kRoadWidthTexels - park, i * length / bays, park, line);
  }
  return Weather(random, &painter, contrast);
}

Texture PaintZebra(Random& random, const CarriagewayLayout& layout, int length, double contrast) {
  Painter painter = MakeAsphaltPainter(random, length, contrast);
  const double texels_per_m = kRoadWidthTexels / layout.width();
  const auto texels = [&](double metres) { return static_cast<int>(std::lround(metres * texels_per_m)); };
  for (double x = 0.3; x + 0.5 < layout.width(); x += 1.0) {
    MarkRectangle(random, &painter, texels(x), texels(0.3), texels(0.5), texels(3.0));
  }
  return Weather(random, &painter, contrast);
}

Texture PaintPavement(Random& random) {
  constexpr int kSize = 512;
  constexpr int kSlab = 64;
  Painter painter(kSize, kSize, 0.42);
  for (int row = 0; row < kSize / kSlab; ++row) {
    for (int column = 0; column < kSize / kSlab; ++column) {
      const int x = column * kSlab + (row % 2) * kSlab / 2;
      painter.Rectangle(x, row * kSlab, kSlab, kSlab, random.Uniform(0.34, 0.5));
      painter.Outline(x, row * kSlab, kSlab, kSlab, 1, 0.15);
    }
  }
  for (int i = 0; i < 12; ++i) {
    painter.Crack(random, random.Uniform() * kSize, random.Uniform() * kSize, 90.0, 1.5, 0.14);
  }
  painter.Noise(random, 128, 128, 5, 0.02, 0.8);
  painter.Grain(random, 0.03);
  for (int i = 0; i < 60; ++i) {
    painter.Ellipse(random.Uniform() * kSize, random.Uniform() * kSize, random.Uniform(1.0, 4.0), 2.0, 0.13);
  }
  return painter.Finish();
}

Texture PaintKerb(Random& random) {
  Painter painter(512, 16, 0.5);
  for (int x = 0; x < 512; x += 128) {
    painter.Rectangle(x, 0, 128, 16, random.Uniform(0.4, 0.6));
    painter.Rectangle(x, 0, 3, 16, 0.12);
  }
  painter.TintGradient(0, 0, 512, 16, 1.1, 0.7);
  painter.Noise(random, 32, 16, 4, 0.03, 0.8);
  return painter.Finish();
}

Texture PaintGround(Random& random) {
  Painter painter(512, 512, 0.24);
  painter.Noise(random, 128, 128, 5, 0.03, 0.85);
  painter.Grain(random, 0.04);
  return painter.Finish();
}

}  // namespace evo::simulation
