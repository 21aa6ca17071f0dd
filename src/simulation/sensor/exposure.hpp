#pragma once

#include <span>

#include "evo/events/grey_image.hpp"

namespace evo::simulation {

/// Turns radiance into grey values as the frames of a DAVIS: linear, clipped, with an exposure that follows the mean
/// brightness of the images before.
class Exposure {
 public:
  /// `radiance` row by row.
  events::GreyImage Expose(int width, int height, std::span<const float> radiance);

 private:
  double gain_ = 0.0;  ///< grey levels per radiance; 0 before the first image
};

}  // namespace evo::simulation
