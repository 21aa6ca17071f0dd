#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace evo::tracking {

/// Cells on either side beyond which a Gaussian is next to nothing; `sigma` in cells.
inline int GaussianReach(double sigma) { return static_cast<int>(std::ceil(3.0 * sigma)); }

/// Fills in a Gaussian's weights for the cells 0, 1, ... away; over both sides they add up to 1.
void FillGaussianKernel(double sigma, std::span<float> kernel);

/// `out` = the cells of `in` weighted by the kernel along a line of cells that are `step` apart. Whole blocks of eight
/// cells: the last may reach up to seven cells beyond.
void ConvolveCells(std::span<const float> kernel, const float* in, std::ptrdiff_t step, std::ptrdiff_t cells,
                   float* out);

}  // namespace evo::tracking
