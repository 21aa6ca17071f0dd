#include <algorithm>
#include <cmath>
#include <vector>

#include "simulation/world/painter.hpp"
#include "simulation/world/textures.hpp"

namespace evo::simulation {

namespace {

constexpr double kBodyPaint = 0.7;  // reflectance; Material::tone makes darker cars

// Texels are higher than wide: 8.4 mm by 6 mm.
void PaintWheel(Painter* painter, double x, double y) {
  const auto disc = [&](double centre_x, double centre_y, double radius, double reflectance) {
    painter->Ellipse(centre_x, centre_y, radius, 1.4 * radius, reflectance);
  };
  disc(x, y, 42.0, 0.05);
  disc(x, y, 37.0, 0.08);
  disc(x, y, 25.0, 0.5);
  for (int i = 0; i < 5; ++i) {
    const double angle = i * 1.2566;
    disc(x + 14.0 * std::cos(angle), y + 19.6 * std::sin(angle), 5.0, 0.08);
  }
  disc(x, y, 5.0, 0.7);
}

}  // namespace

Texture PaintCarSide(double rear) {
  Painter painter(512, 256, 0.1, 0.0);
  // Cabin: columns from the wind screen's foot to the rear; below it the body.
  for (int x = 130; x < 508; ++x) {
    const double front = 110.0 - (x - 130);
    const double back = 110.0 - 2.2 * (rear - x);
    const int top = static_cast<int>(std::max({6.0, front, back}));
    if (top < 110) painter.Rectangle(x, top, 1, 110 - top, kBodyPaint);
    const int glass = top + 14;
    const bool pillar = std::abs(x - 300) < 6 || x < 155 || x > rear - 25;
    if (glass < 100 && !pillar) painter.Rectangle(x, glass, 1, 102 - glass, 0.09 + 0.05 * ((x / 40) % 2));
  }
  painter.Rectangle(4, 108, 504, 100, kBodyPaint);
  painter.TintGradient(4, 108, 504, 100, 1.15, 0.65);
  painter.Rectangle(4, 196, 504, 14, 0.12);                                   // sill
  for (const int x : {165, 300, 415}) painter.Rectangle(x, 106, 2, 90, 0.2);  // doors
  for (const int x : {270, 390}) painter.Rectangle(x, 124, 22, 5, 0.2);       // handles
  painter.Rectangle(4, 122, 26, 18, 0.85);
  painter.Rectangle(490, 122, 18, 20, 0.25);
  painter.CutHole(0, 100, 6, 30);
  for (const double x : {100.0, 405.0}) PaintWheel(&painter, x, 200.0);
  return painter.Finish();
}

Texture PaintCarEnd(Random& random, bool front) {
  Painter painter(256, 128, kBodyPaint);
  painter.Rectangle(0, 96, 256, 32, 0.15);
  if (front) painter.Rectangle(60, 34, 136, 26, random.Chance(0.5) ? 0.1 : 0.55);
  painter.Rectangle(98, 66, 60, 18, 0.85);
  painter.Lettering(random, 101, 69, 54, 12, 0.08);
  for (const int x : {8, 208}) {
    painter.Rectangle(x, 24, 40, 26, front ? 0.88 : 0.22);
    painter.Outline(x, 24, 40, 26, 3, 0.15);
  }
  painter.Rectangle(0, 62, 256, 2, 0.3);
  return painter.Finish();
}

Texture PaintCarPaint(Random& random) {
  Painter painter(64, 64, kBodyPaint);
  painter.Noise(random, 32, 32, 3, 0.03);
  painter.Outline(0, 0, 64, 64, 1, 0.2);
  return painter.Finish();
}

Texture PaintCarGlass(Random& random) {
  Painter painter(64, 64, 0.1);
  painter.TintGradient(0, 0, 64, 64, 2.5, 0.9);
  painter.Noise(random, 32, 32, 3, 0.02);
  painter.Outline(0, 0, 64, 64, 2, 0.06);
  return painter.Finish();
}

Texture PaintCarShadow() {
  std::vector<Texel> texels(64 * 128);
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double edge = std::min({x + 0.5, 63.5 - x, y + 0.5, 127.5 - y}) / 8.0;
      texels[static_cast<std::size_t>(y) * 64 + x] = {0.06F, static_cast<float>(std::clamp(edge - 0.06, 0.0, 0.85))};
    }
  }
  return Texture(64, 128, texels);
}

Texture PaintGlow() {
  std::vector<Texel> texels(64 * 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double square = std::pow((x - 31.5) / 31.5, 2) + std::pow((y - 31.5) / 31.5, 2);
      texels[static_cast<std::size_t>(y) * 64 + x] = {0.06F, static_cast<float>(std::max(0.0, 1.0 - square))};
    }
  }
  return Texture(64, 64, texels);
}

Texture PaintChassis() {
  Painter painter(512, 64, 0.08, 0.0);
  painter.Rectangle(0, 0, 512, 24, 0.08);
  for (const double x : {60.0, 380.0, 450.0}) {
    painter.Ellipse(x, 34.0, 33.0, 30.0, 0.06);
    painter.Ellipse(x, 34.0, 17.0, 15.0, 0.45);
    painter.Ellipse(x, 34.0, 5.0, 5.0, 0.1);
  }
  return painter.Finish();
}

Texture PaintTorso(Random& random) {
  const double coat = random.Chance(0.5) ? random.Uniform(0.08, 0.25) : random.Uniform(0.3, 0.7);
  Painter painter(64, 128, coat, 0.0);
  painter.Ellipse(32.0, 46.0, 21.0, 16.0, coat);
  painter.Rectangle(11, 46, 42, 54, coat);
  painter.Rectangle(16, 96, 32, 31, coat);
  for (const int x : {4, 52}) painter.Rectangle(x, 44, 8, 60, 0.8 * coat);
  painter.Ellipse(32.0, 16.0, 10.0, 14.0, 0.4);
  painter.Ellipse(32.0, 9.0, 10.0, 8.0, random.Uniform(0.06, 0.3));
  if (random.Chance(0.5)) painter.Rectangle(14, 58, 36, 9, random.Uniform(0.1, 0.8));
  painter.Rectangle(31, 46, 2, 54, 0.5 * coat);
  return painter.Finish();
}

}  // namespace evo::simulation
