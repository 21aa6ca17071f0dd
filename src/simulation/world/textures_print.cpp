#include <algorithm>

#include "simulation/world/painter.hpp"
#include "simulation/world/textures.hpp"

namespace evo::simulation {

namespace {

double DarkOrLight(Random& random) { return random.Chance(0.5) ? random.Uniform(0.05, 0.2) : random.Uniform(0.6, 0.9); }

void PaintTriangle(Random& random, Painter* painter, double x, double y, double size, double reflectance) {
  const double lean = random.Uniform(-0.5, 0.5);
  for (double row = 0.0; row < size; row += 1.0) {
    painter->Rectangle(static_cast<int>(x + row * (lean - 0.5)), static_cast<int>(y + row), static_cast<int>(row) + 1,
                       1, reflectance);
  }
}

void PaintShape(Random& random, Painter* painter, double x, double y, double size) {
  const double reflectance = DarkOrLight(random);
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const int side = static_cast<int>(size);
  switch (random.Index(6)) {
    case 0:
      painter->Rectangle(left, top, side, static_cast<int>(size * random.Uniform(0.4, 1.4)), reflectance);
      break;
    case 1:
      painter->Ellipse(x, y, size / 2.0, size / 2.0 * random.Uniform(0.6, 1.0), reflectance);
      break;
    case 2:
      PaintTriangle(random, painter, x, y, size, reflectance);
      break;
    case 3:
      painter->Outline(left, top, side, side, std::max(3, side / 6), reflectance);
      break;
    case 4:
      painter->Line(x, y, x + size * random.Normal(), y + size * random.Normal(), size / 6.0, reflectance);
      break;
    default:
      painter->Lettering(random, left, top, 2 * side, std::max(10, side / 3), reflectance);
  }
}

void PaintShapes(Random& random, Painter* painter, int count, double smallest, double largest) {
  for (int i = 0; i < count; ++i) {
    PaintShape(random, painter, random.Uniform() * painter->width(), random.Uniform() * painter->height(),
               random.Uniform(smallest, largest));
  }
}

}  // namespace

Texture PaintShopSign(Random& random) {
  const bool dark = random.Chance(0.5);
  Painter painter(256, 64, dark ? 0.1 : 0.75);
  painter.Outline(0, 0, 256, 64, 4, dark ? 0.6 : 0.15);
  painter.Lettering(random, 20, 16, 216, 32, dark ? 0.85 : 0.08);
  return painter.Finish();
}

Texture PaintTrafficSign(Random& random) {
  Painter painter(64, 64, 0.5, 0.0);
  if (random.Chance(0.6)) {
    painter.Ellipse(32.0, 32.0, 31.0, 31.0, 0.25);
    painter.Ellipse(32.0, 32.0, 23.0, 23.0, 0.85);
    painter.Lettering(random, 17, 22, 32, 20, 0.06);
  } else {
    painter.Rectangle(2, 2, 60, 60, 0.2);
    painter.Outline(2, 2, 60, 60, 4, 0.85);
    painter.Lettering(random, 14, 14, 38, 36, 0.85);
  }
  return painter.Finish();
}

Texture PaintPoster(Random& random) {
  Painter painter(512, 512, random.Uniform(0.4, 0.8));
  PaintShapes(random, &painter, 40, 30.0, 130.0);
  PaintShapes(random, &painter, 60, 10.0, 40.0);
  painter.Noise(random, 64, 64, 3, 0.01);
  return painter.Finish();
}

Texture PaintPlacard(Random& random) {
  Painter painter(512, 512, random.Uniform(0.6, 0.85));
  PaintShapes(random, &painter, 7, 60.0, 160.0);
  for (int line = 0; line < 3; ++line) {
    painter.Lettering(random, 40, 60 + 150 * line, 160 + random.Index(280), 36, 0.08);
  }
  painter.Outline(0, 0, 512, 512, 8, 0.1);
  return painter.Finish();
}

Texture PaintPicture(Random& random) {
  Painter painter(512, 512, 0.4);
  painter.Noise(random, 128, 128, 7, 0.11, 0.72);
  PaintShapes(random, &painter, 25, 20.0, 90.0);
  for (int i = 0; i < 900; ++i) {  // rocks: light above, dark below
    const double x = random.Uniform() * 512.0;
    const double y = random.Uniform() * 512.0;
    const double radius = 3.0 + 5.0 * random.Exponential();
    painter.Ellipse(x, y, radius * 1.3, radius, 0.1);
    painter.Ellipse(x - 0.2 * radius, y - 0.25 * radius, radius, radius * 0.7, random.Uniform(0.25, 0.8));
  }
  painter.Noise(random, 32, 32, 5, 0.03, 0.8);
  return painter.Finish();
}

Texture PaintBoxSide(Random& random) {
  Painter painter(256, 256, random.Uniform(0.3, 0.7));
  painter.Noise(random, 64, 64, 4, 0.015);
  painter.Rectangle(0, 112, 256, 24, random.Uniform(0.55, 0.8));  // tape
  PaintShapes(random, &painter, 10, 15.0, 60.0);
  for (int line = 0; line < 3; ++line) {
    painter.Lettering(random, 20, 30 + 22 * line, 60 + random.Index(150), 13, DarkOrLight(random));
  }
  painter.Outline(0, 0, 256, 256, 2, 0.15);
  return painter.Finish();
}

Texture PaintPlain(Random& random, double reflectance) {
  Painter painter(64, 64, reflectance);
  painter.Noise(random, 16, 16, 3, reflectance * 0.05);
  return painter.Finish();
}

}  // namespace evo::simulation
