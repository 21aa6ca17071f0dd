#pragma once

#include <vector>

namespace evo::simulation {

/// One element of a texture.
struct Texel {
  float reflectance = 0.5F;  ///< diffuse, in (0, 1]
  float coverage = 1.0F;     ///< opacity: 0 is a hole (between leaves), 1 is solid
};

/// A grey texture with a mip map (L. Williams, Pyramidal Parametrics, SIGGRAPH 1983). Texel (0, 0) has its centre at
/// u = v = 0.5; the texture repeats in both directions. Reflectance is stored multiplied with coverage, so that the
/// reflectance of a hole has no effect on its surroundings.
class Texture {
 public:
  /// Sizes are powers of two; `texels` row by row. Throws Error(kInput) otherwise.
  Texture(int width, int height, const std::vector<Texel>& texels);

  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }
  /// Scales the deviations of the reflectance from its mean by `factor`, on all levels alike.
  void ScaleContrast(float factor);

  /// Makes the texture see-through: scales its coverage by `factor` below 1.
  void ScaleCoverage(float factor);

  /// True for a texture without holes.
  bool solid() const { return solid_; }

  /// Trilinear interpolation; `footprint` is the width of the sample in texels of level 0 (>= 0).
  Texel Lookup(double u, double v, double footprint) const;

  struct Sample {
    float reflected = 0.0F;  ///< reflectance times coverage
    float coverage = 0.0F;
  };
  /// As Lookup, for |u|, |v| < 2^24 and the footprint as a mip level, log2(footprint).
  Sample LookupAtLevel(float u, float v, float mip_level) const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    float scale_u = 1.0F;  ///< texels of this level per texel of level 0
    float scale_v = 1.0F;
    int first = 0;  ///< index in samples_
  };
  Sample Bilinear(const Level& level, float u, float v) const;
  void AddLevel(const Level& finer);

  bool solid_ = true;
  std::vector<Level> levels_;
  std::vector<Sample> samples_;
};

}  // namespace evo::simulation
