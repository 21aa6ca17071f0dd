#pragma once

#include <vector>

#include "evo/core/random.hpp"
#include "evo/simulation/texture.hpp"

namespace evo::simulation {

/// Draws a texture. It has no borders: what leaves on one side comes in on the other. Sizes in texels.
class Painter {
 public:
  /// Sizes are powers of two. Starts with one reflectance and coverage everywhere.
  Painter(int width, int height, double reflectance, double coverage = 1.0);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Solid paint.
  void Rectangle(int x, int y, int width, int height, double reflectance);
  void Outline(int x, int y, int width, int height, int thickness, double reflectance);
  void Ellipse(double x, double y, double radius_x, double radius_y, double reflectance);
  void Line(double x0, double y0, double x1, double y1, double thickness, double reflectance);
  /// Multiplies the reflectance: shadows, stains, worn paint.
  void Tint(int x, int y, int width, int height, double factor);
  /// From the factor at the top to that at the bottom.
  void TintDown(int x, int y, int width, int height, double top, double bottom);
  void Hole(int x, int y, int width, int height);

  /// Adds smooth noise with features of `cell` texels (a power of two, at most the size) of standard deviation about
  /// `amplitude`, and `octaves` - 1 finer ones, each half as coarse and of `gain` of the strength.
  void Noise(Random& random, int cell_x, int cell_y, int octaves, double amplitude, double gain = 0.6);
  /// Noise from texel to texel.
  void Grain(Random& random, double amplitude);
  /// A line that wanders: a crack, a twig.
  void Crack(Random& random, double x, double y, double length, double thickness, double reflectance);
  /// Blobs in rows like lettering, in the given box.
  void Lettering(Random& random, int x, int y, int width, int height, double reflectance);

  /// Reflectances are brought into [0.05, 0.9]. Leaves nothing behind.
  Texture Finish();

 private:
  Texel& At(int x, int y) {
    return texels_[static_cast<std::size_t>((y & (height_ - 1)) * width_ + (x & (width_ - 1)))];
  }
  void AddOctave(Random& random, int cell_x, int cell_y, double amplitude);

  int width_;
  int height_;
  std::vector<Texel> texels_;
};

}  // namespace evo::simulation
