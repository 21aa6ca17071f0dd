#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace evo::simulation {

/// What a surface shows at one place.
struct Texel {
  float reflectance = 0.5F;  ///< share of the light that is sent back, in (0, 1]
  float coverage = 1.0F;     ///< 0: a hole that is looked through (between leaves), 1: solid
};

/// A grey picture with a pyramid of halved copies, so that it can be looked up without aliasing from any distance.
/// Texel (0, 0) has its centre at u = v = 0.5; it repeats in both directions. Reflectance is averaged and interpolated
/// with coverage as its weight, so that what a hole would reflect never shows.
class Texture {
 public:
  /// Sizes are powers of two; `texels` row by row. Throws Error(kInput) otherwise.
  Texture(int width, int height, const std::vector<Texel>& texels);

  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }
  /// Whether there is no hole in it.
  bool solid() const { return solid_; }

  /// Trilinear; `footprint` is the size of the sample in texels of the full picture (>= 0).
  Texel At(double u, double v, double footprint) const;

  /// What a sample sends back (reflectance times coverage) and how much of it is covered.
  struct Sample {
    float reflected = 0.0F;
    float coverage = 0.0F;
  };
  /// As At, for |u|, |v| < 2^24 and the footprint as a level of the pyramid, log2(footprint).
  Sample AtLevel(float u, float v, float level) const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    float scale = 1.0F;  ///< texels of this level in one of the full picture, across and
    float scale_v = 1.0F;
    int first = 0;  ///< in samples_
  };
  Sample Bilinear(const Level& level, float u, float v) const;
  void AddLevel(const Level& finer);

  bool solid_ = true;
  std::vector<Level> levels_;
  std::vector<Sample> samples_;
};

/// log2 of a positive, normal number to 0.01; continuous and the same on every machine.
inline float QuickLog2(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const float m = std::bit_cast<float>((bits & 0x007FFFFFU) | 0x3F800000U);
  const auto exponent = static_cast<float>(static_cast<int>(bits >> 23) - 127);
  return exponent + (2.0F - m * (1.0F / 3.0F)) * m - 5.0F / 3.0F;
}

}  // namespace evo::simulation
