#pragma once

#include <cstddef>
#include <vector>

namespace evo::simulation {

/// Pixels x0 <= x < x0 + width, y0 <= y < y0 + height of the raw image.
struct Tile {
  int x0 = 0;
  int y0 = 0;
  int width = 0;
  int height = 0;

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// The sensor cut into tiles of at most `size` x `size` px, row by row.
std::vector<Tile> CutIntoTiles(int width, int height, int size);

}  // namespace evo::simulation
