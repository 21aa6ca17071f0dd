#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tracking/patch/density_map.hpp"
#include "tracking/patch/lanes.hpp"

namespace evo::tracking {

constexpr float kOutside = 1e6f;  // px: of what is no event, outside every map

/// Where the cells of the polarities of eight events begin: of negative ones at `second`.
EVO_INLINE void FindPlanes(std::span<const std::int8_t> polarity, std::size_t begin, std::int32_t second,
                           std::int32_t* planes) {
  if (begin + kLanes <= polarity.size()) {
    for (int i = 0; i < kLanes; ++i) planes[i] = polarity[begin + i] < 0 ? second : 0;
    return;
  }
  for (int i = 0; i < kLanes; ++i) planes[i] = begin + i < polarity.size() && polarity[begin + i] < 0 ? second : 0;
}

/// AssociationField::At of eight events at (u, v), a column for each part of the pull.
EVO_INLINE void PullsAt(const AssociationField& field, const Lanes& u, const Lanes& v, const std::int32_t* planes,
                        LaneColumns* pulls) {
  const auto radius = static_cast<float>(field.radius());
  const auto side = static_cast<float>(field.side());
  const Lanes zero{};
  const Lanes last = zero + (side - 1.0f);
  // What lies outside is moved to the edge, where nothing pulls.
  Lanes column = u + radius;
  Lanes row = v + radius;
  column = column > zero ? column : zero;
  column = column < last ? column : last;
  row = row > zero ? row : zero;
  row = row < last ? row : last;
  LaneCells cells;
  FindCells(column, row, side, &cells);
  FourLanes at[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const float* const above = field.table()[planes[i] + cells.index[i]].data();
    Lanes two, below;
    Load(above, &two);
    Load(above + 4 * field.side(), &below);
    two += cells.fy[i] * (below - two);
    FourLanes left, right;
    Split(two, &left, &right);
    at[i] = left + cells.fx[i] * (right - left);
  }
  ToColumns(at, pulls);
}

}  // namespace evo::tracking
