#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace evo::tracking {

/// One half of a Gaussian, for the cells 0, 1, ... away from its centre: to three sigmas, but not beyond `max_radius`
/// cells. Both halves together add up to 1. `sigma` is in cells.
std::vector<float> MakeGaussianKernel(double sigma, int max_radius);

/// Convolves `in` with a symmetric kernel along a line of cells that lie `step` apart. Works on blocks of eight cells:
/// reads and writes up to seven cells beyond the last.
void ConvolveCells(std::span<const float> kernel, const float* in, std::ptrdiff_t step, std::ptrdiff_t cells,
                   float* out);

}  // namespace evo::tracking
