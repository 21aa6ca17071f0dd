#pragma once

#include <vector>

#include "evo/core/random.hpp"
#include "simulation/world/texture.hpp"

namespace evo::simulation {

/// Draws a texture that repeats: what leaves on one side enters on the other. Sizes in texels.
///
/// Lines and ellipses are not OpenCV's: those do not repeat, and their edges cover other texels, which would change
/// every simulated byte.
class Painter {
 public:
  /// Sizes are powers of two. All texels start with the same reflectance and coverage.
  Painter(int width, int height, double reflectance, double coverage = 1.0);

  int width() const { return width_; }
  int height() const { return height_; }

  // Solid paint.
  void Rectangle(int x, int y, int width, int height, double reflectance);
  void Outline(int x, int y, int width, int height, int thickness, double reflectance);
  void Ellipse(double x, double y, double radius_x, double radius_y, double reflectance);
  void Line(double x0, double y0, double x1, double y1, double thickness, double reflectance);
  /// Multiplies the reflectance: shadows, stains, worn paint.
  void Tint(int x, int y, int width, int height, double factor);
  /// Multiplies the reflectance by a factor that is linear from top to bottom.
  void TintGradient(int x, int y, int width, int height, double top, double bottom);
  /// Scales the deviations of the reflectance from its mean by `factor`.
  void ScaleContrast(double factor);
  /// Sets the coverage to 0.
  void CutHole(int x, int y, int width, int height);

  /// Adds value noise of `octaves` octaves. The first has cells of `cell_x` x `cell_y` texels (powers of two) and a
  /// standard deviation of about `amplitude`; each further one has cells of half the size and `gain` times the
  /// amplitude.
  void Noise(Random& random, int cell_x, int cell_y, int octaves, double amplitude, double gain = 0.6);
  /// Adds white noise of the standard deviation `amplitude`.
  void Grain(Random& random, double amplitude);
  /// A random walk: a crack, a twig.
  void Crack(Random& random, double x, double y, double length, double thickness, double reflectance);
  /// Strokes like a line of lettering in the given box.
  void Lettering(Random& random, int x, int y, int width, int height, double reflectance);

  /// Clamps reflectances to [0.05, 0.9], those of black and white paint, and hands over the texels.
  Texture Finish();

 private:
  Texel& TexelAt(int x, int y) {
    return texels_[static_cast<std::size_t>((y & (height_ - 1)) * width_ + (x & (width_ - 1)))];
  }
  void AddOctave(Random& random, int cell_x, int cell_y, double amplitude);

  int width_;
  int height_;
  std::vector<Texel> texels_;
};

}  // namespace evo::simulation
