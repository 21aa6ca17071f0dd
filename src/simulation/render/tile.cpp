#include "simulation/render/tile.hpp"

#include <algorithm>

namespace evo::simulation {

std::vector<Tile> CutIntoTiles(int width, int height, int size) {
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += size) {
    for (int x = 0; x < width; x += size) {
      tiles.push_back({x, y, std::min(size, width - x), std::min(size, height - y)});
    }
  }
  return tiles;
}

}  // namespace evo::simulation
