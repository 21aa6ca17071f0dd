#include "simulation/world/texture.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstddef>

#include "evo/core/error.hpp"
#include "simulation/fast_math.hpp"

namespace evo::simulation {

namespace {

/// A cast and a correction, since std::floor is a function call without SSE4.1.
int Floor(float x) {
  const int i = static_cast<int>(x);
  return i - static_cast<int>(static_cast<float>(i) > x);
}

Texture::Sample Interpolate(Texture::Sample a, Texture::Sample b, float weight) {
  return {a.reflected + weight * (b.reflected - a.reflected), a.coverage + weight * (b.coverage - a.coverage)};
}

}  // namespace

Texture::Texture(int width, int height, const std::vector<Texel>& texels) {
  const auto power_of_two = [](int n) { return n > 0 && std::has_single_bit(static_cast<unsigned>(n)); };
  if (!power_of_two(width) || !power_of_two(height) ||
      texels.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw Error(ErrorKind::kInput,
                fmt::format("texture: {} texels for {} x {}; sizes must be powers of two and have one texel each",
                            texels.size(), width, height));
  }
  samples_.reserve(texels.size() * 4 / 3 + 64);  // the levels' geometric series
  for (const Texel& texel : texels) {
    samples_.push_back({texel.reflectance * texel.coverage, texel.coverage});
    solid_ = solid_ && texel.coverage >= 1.0F;
  }
  levels_.push_back({.width = width, .height = height});
  while (levels_.back().width > 1 || levels_.back().height > 1) AddLevel(Level(levels_.back()));
}

void Texture::AddLevel(const Level& finer) {
  const int across = finer.width > 1 ? 2 : 1;
  const int down = finer.height > 1 ? 2 : 1;
  Level level{finer.width / across, finer.height / down, finer.scale_u / static_cast<float>(across),
              finer.scale_v / static_cast<float>(down), static_cast<int>(samples_.size())};
  for (int y = 0; y < level.height; ++y) {
    for (int x = 0; x < level.width; ++x) {
      Sample sum;
      for (int j = 0; j < down; ++j) {
        for (int i = 0; i < across; ++i) {
          const Sample& s = samples_[finer.first + (y * down + j) * finer.width + x * across + i];
          sum.reflected += s.reflected;
          sum.coverage += s.coverage;
        }
      }
      const float weight = 1.0F / static_cast<float>(across * down);
      samples_.push_back({sum.reflected * weight, sum.coverage * weight});
    }
  }
  levels_.push_back(level);
}

void Texture::ScaleContrast(float factor) {
  if (samples_.back().coverage <= 0.0F) return;
  const float mean = samples_.back().reflected / samples_.back().coverage;
  for (Sample& s : samples_) s.reflected = mean * s.coverage + factor * (s.reflected - mean * s.coverage);
}

void Texture::ScaleCoverage(float factor) {
  for (Sample& s : samples_) s = {factor * s.reflected, factor * s.coverage};
  solid_ = solid_ && factor >= 1.0F;
}

// BilinearCell of core does not fit: coordinates may be negative, and a right neighbour may be the row's first texel.
Texture::Sample Texture::Bilinear(const Level& level, float u, float v) const {
  const float x = u * level.scale_u - 0.5F;
  const float y = v * level.scale_v - 0.5F;
  const int left = Floor(x);
  const int top = Floor(y);
  const float dx = x - static_cast<float>(left);
  const float dy = y - static_cast<float>(top);
  const int x0 = left & (level.width - 1);
  const int x1 = (left + 1) & (level.width - 1);
  const Sample* row0 = &samples_[level.first + (top & (level.height - 1)) * level.width];
  const Sample* row1 = &samples_[level.first + ((top + 1) & (level.height - 1)) * level.width];
  return Interpolate(Interpolate(row0[x0], row0[x1], dx), Interpolate(row1[x0], row1[x1], dx), dy);
}

Texture::Sample Texture::LookupAtLevel(float u, float v, float mip_level) const {
  if (!(mip_level > 0.0F)) return Bilinear(levels_.front(), u, v);
  const auto last = static_cast<int>(levels_.size()) - 1;
  if (mip_level >= static_cast<float>(last)) return samples_.back();
  const int finer = static_cast<int>(mip_level);
  return Interpolate(Bilinear(levels_[finer], u, v), Bilinear(levels_[finer + 1], u, v),
                     mip_level - static_cast<float>(finer));
}

Texel Texture::Lookup(double u, double v, double footprint) const {
  const auto wrap = [](double x, int size) { return static_cast<float>(x - std::floor(x / size) * size); };
  const float mip_level = footprint > 1.0 ? FastLog2(static_cast<float>(footprint)) : 0.0F;
  const Sample sample = LookupAtLevel(wrap(u, width()), wrap(v, height()), mip_level);
  return {sample.coverage > 0.0F ? sample.reflected / sample.coverage : 0.5F, sample.coverage};
}

}  // namespace evo::simulation
