#pragma once

#include <span>

#include "evo/events/grey_image.hpp"

namespace evo::simulation {

/// Converts radiance into grey values like the frames of a DAVIS: linear, clipped, with an exposure that adapts to the
/// mean brightness of the previous images.
class AutoExposure {
 public:
  /// `radiance` row by row.
  events::GreyImage Expose(int width, int height, std::span<const float> radiance);

 private:
  double gain_ = 0.0;  ///< grey levels per radiance; 0 before the first image
};

}  // namespace evo::simulation
