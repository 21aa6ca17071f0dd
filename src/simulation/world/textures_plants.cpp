#include <cmath>
#include <numbers>

#include "simulation/world/painter.hpp"
#include "simulation/world/textures.hpp"

namespace evo::simulation {

namespace {

constexpr int kSize = 256;

void PaintLeaf(Random& random, Painter* painter, double x, double y, double light) {
  const double radius = random.Uniform(1.5, 4.5);
  painter->Ellipse(x, y, radius, radius * random.Uniform(0.5, 1.5), light * random.Uniform(0.12, 0.45));
}

}  // namespace

Texture PaintFoliage(Random& random) {
  Painter painter(kSize, kSize, 0.15, 0.0);
  for (int i = 0; i < 5; ++i) {
    painter.Crack(random, kSize / 2.0 + 10.0 * random.Normal(), kSize * 0.55, 110.0, 3.0, 0.1);
  }
  constexpr int kClumps = 34;
  for (int i = 0; i < kClumps; ++i) {
    // Clumps of leaves within a circle, the upper ones lighter.
    const double angle = random.Uniform(0.0, 2.0 * std::numbers::pi);
    const double distance = 92.0 * std::sqrt(random.Uniform());
    const double x = kSize / 2.0 + distance * std::cos(angle);
    const double y = kSize / 2.0 + distance * std::sin(angle);
    const double light = 1.25 - 0.5 * y / kSize;
    for (int leaf = 0; leaf < 55; ++leaf) {
      const double around = random.Uniform(0.0, 2.0 * std::numbers::pi);
      const double away = 26.0 * std::sqrt(random.Uniform());
      PaintLeaf(random, &painter, x + away * std::cos(around), y + away * std::sin(around), light);
    }
  }
  return painter.Finish();
}

Texture PaintHedge(Random& random) {
  Painter painter(kSize, kSize, 0.1, 1.0);
  painter.CutHole(0, 0, kSize, 40);
  for (int i = 0; i < 5000; ++i) {
    const double height = std::abs(random.Normal()) * 14.0;  // ragged above, closed below
    const double y = random.Chance(0.3) ? 46.0 - height : random.Uniform(38.0, kSize - 6.0);
    if (y < 5.0) continue;
    PaintLeaf(random, &painter, random.Uniform() * kSize, y, 1.2 - 0.5 * y / kSize);
  }
  return painter.Finish();
}

Texture PaintBark(Random& random) {
  Painter painter(64, 256, 0.2);
  painter.Noise(random, 8, 64, 4, 0.05, 0.8);
  for (int i = 0; i < 20; ++i) {
    painter.Rectangle(random.Index(64), random.Index(256), 2, 20 + random.Index(40), 0.07);
  }
  return painter.Finish();
}

Texture PaintFence(Random& random) {
  Painter painter(256, 64, 0.5, 0.0);
  const double reflectance = random.Uniform(0.25, 0.75);
  for (const int y : {12, 48}) painter.Rectangle(0, y, 256, 5, reflectance * 0.8);
  for (int x = 0; x < 256; x += 16) painter.Rectangle(x, 2, 9, 62, reflectance * random.Uniform(0.8, 1.15));
  return painter.Finish();
}

}  // namespace evo::simulation
