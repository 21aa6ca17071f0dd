#include "simulation/world/painter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace evo::simulation {

namespace {

constexpr float kMinReflectance = 0.05F;  // of black paint
constexpr float kMaxReflectance = 0.9F;   // of white paint

}  // namespace

Painter::Painter(int width, int height, double reflectance, double coverage)
    : width_(width),
      height_(height),
      texels_(static_cast<std::size_t>(width) * height,
              Texel{static_cast<float>(reflectance), static_cast<float>(coverage)}) {}

void Painter::Rectangle(int x, int y, int width, int height, double reflectance) {
  for (int j = y; j < y + height; ++j) {
    for (int i = x; i < x + width; ++i) TexelAt(i, j) = {static_cast<float>(reflectance), 1.0F};
  }
}

void Painter::Outline(int x, int y, int width, int height, int thickness, double reflectance) {
  Rectangle(x, y, width, thickness, reflectance);
  Rectangle(x, y + height - thickness, width, thickness, reflectance);
  Rectangle(x, y, thickness, height, reflectance);
  Rectangle(x + width - thickness, y, thickness, height, reflectance);
}

void Painter::Ellipse(double x, double y, double radius_x, double radius_y, double reflectance) {
  for (int j = static_cast<int>(std::floor(y - radius_y)); j <= static_cast<int>(std::ceil(y + radius_y)); ++j) {
    for (int i = static_cast<int>(std::floor(x - radius_x)); i <= static_cast<int>(std::ceil(x + radius_x)); ++i) {
      const double u = (i + 0.5 - x) / radius_x;
      const double v = (j + 0.5 - y) / radius_y;
      if (u * u + v * v <= 1.0) TexelAt(i, j) = {static_cast<float>(reflectance), 1.0F};
    }
  }
}

void Painter::Line(double x0, double y0, double x1, double y1, double thickness, double reflectance) {
  const double step = std::max(0.5, thickness / 4.0);
  const int steps = std::max(1, static_cast<int>(std::ceil(std::hypot(x1 - x0, y1 - y0) / step)));
  for (int i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    const double radius = std::max(0.71, thickness / 2.0);
    Ellipse(x0 + s * (x1 - x0), y0 + s * (y1 - y0), radius, radius, reflectance);
  }
}

void Painter::Tint(int x, int y, int width, int height, double factor) {
  TintGradient(x, y, width, height, factor, factor);
}

void Painter::TintGradient(int x, int y, int width, int height, double top, double bottom) {
  for (int j = 0; j < height; ++j) {
    const auto factor = static_cast<float>(top + (bottom - top) * j / std::max(1, height - 1));
    for (int i = 0; i < width; ++i) TexelAt(x + i, y + j).reflectance *= factor;
  }
}

void Painter::ScaleContrast(double factor) {
  double sum = 0.0;
  for (const Texel& texel : texels_) sum += texel.reflectance;
  const auto mean = static_cast<float>(sum / static_cast<double>(texels_.size()));
  for (Texel& texel : texels_) texel.reflectance = mean + static_cast<float>(factor) * (texel.reflectance - mean);
}

void Painter::CutHole(int x, int y, int width, int height) {
  for (int j = y; j < y + height; ++j) {
    for (int i = x; i < x + width; ++i) TexelAt(i, j).coverage = 0.0F;
  }
}

void Painter::Noise(Random& random, int cell_x, int cell_y, int octaves, double amplitude, double gain) {
  for (int octave = 0; octave < octaves; ++octave) {
    AddOctave(random, cell_x, cell_y, amplitude);
    cell_x = std::max(1, cell_x / 2);
    cell_y = std::max(1, cell_y / 2);
    amplitude *= gain;
  }
}

void Painter::AddOctave(Random& random, int cell_x, int cell_y, double amplitude) {
  cell_x = std::min(cell_x, width_);
  cell_y = std::min(cell_y, height_);
  const int columns = width_ / cell_x;
  const int rows = height_ / cell_y;
  // Uniform values in [-2.6, 2.6] have a standard deviation of about 1 after interpolation between the lattice points.
  std::vector<float> lattice(static_cast<std::size_t>(columns) * rows);
  for (float& value : lattice) value = static_cast<float>(random.Uniform(-2.6, 2.6) * amplitude);
  const auto smooth = [](float s) { return s * s * (3.0F - 2.0F * s); };
  for (int y = 0; y < height_; ++y) {
    const float* above = &lattice[static_cast<std::size_t>(y / cell_y) * columns];
    const float* below = &lattice[static_cast<std::size_t>((y / cell_y + 1) % rows) * columns];
    const float sy = smooth(static_cast<float>(y % cell_y) / static_cast<float>(cell_y));
    for (int c = 0; c < columns; ++c) {
      const int next = (c + 1) % columns;
      const float left = above[c] + sy * (below[c] - above[c]);
      const float right = above[next] + sy * (below[next] - above[next]);
      Texel* row = &texels_[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(c) * cell_x];
      for (int i = 0; i < cell_x; ++i) {
        row[i].reflectance += left + smooth(static_cast<float>(i) / static_cast<float>(cell_x)) * (right - left);
      }
    }
  }
}

void Painter::Grain(Random& random, double amplitude) {
  const double half_width = std::sqrt(3.0) * amplitude;
  for (Texel& texel : texels_) texel.reflectance += static_cast<float>(random.Uniform(-half_width, half_width));
}

void Painter::Crack(Random& random, double x, double y, double length, double thickness, double reflectance) {
  double heading = random.Uniform(0.0, 2.0 * std::numbers::pi);
  constexpr double kStep = 6.0;
  for (double travelled = 0.0; travelled < length; travelled += kStep) {
    heading += 0.35 * random.Normal();
    const double next_x = x + kStep * std::cos(heading);
    const double next_y = y + kStep * std::sin(heading);
    Line(x, y, next_x, next_y, thickness, reflectance);
    x = next_x;
    y = next_y;
  }
}

void Painter::Lettering(Random& random, int x, int y, int width, int height, double reflectance) {
  const int stroke = std::max(1, height / 7);
  const int letter = std::max(3, height * 6 / 10);
  for (int left = x; left + letter <= x + width; left += letter + 2 * stroke) {
    if (random.Chance(0.12)) continue;  // a space
    if (random.Chance(0.8)) Rectangle(left, y, stroke, height, reflectance);
    if (random.Chance(0.5)) Rectangle(left + letter - stroke, y, stroke, height, reflectance);
    if (random.Chance(0.6)) Rectangle(left, y, letter, stroke, reflectance);
    if (random.Chance(0.6)) Rectangle(left, y + height / 2, letter, stroke, reflectance);
    if (random.Chance(0.5)) Rectangle(left, y + height - stroke, letter, stroke, reflectance);
    if (random.Chance(0.3)) Line(left, y, left + letter - 1, y + height - 1, stroke, reflectance);
  }
}

Texture Painter::Finish() {
  for (Texel& texel : texels_) texel.reflectance = std::clamp(texel.reflectance, kMinReflectance, kMaxReflectance);
  return Texture(width_, height_, texels_);
}

}  // namespace evo::simulation
