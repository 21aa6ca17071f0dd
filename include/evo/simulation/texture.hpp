#pragma once

#include <cstddef>
#include <vector>

namespace evo {

/// What a surface shows at one place.
struct Texel {
  float reflectance = 0.5F;  ///< share of the light that is sent back, in (0, 1]
  float coverage = 1.0F;     ///< 0: a hole that is looked through (between leaves), 1: solid
};

/// A grey picture with a pyramid of halved copies, so that it can be looked up without aliasing from any distance.
/// Texel (0, 0) has its centre at u = v = 0.5; it repeats in both directions.
class Texture {
 public:
  /// Sizes are powers of two; `texels` row by row.
  Texture(int width, int height, std::vector<Texel> texels);

  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }
  /// Trilinear; `footprint` is the size of the sample in texels of the full picture (>= 0).
  Texel At(double u, double v, double footprint) const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<Texel> texels;
  };
  std::vector<Level> levels_;
};

}  // namespace evo
