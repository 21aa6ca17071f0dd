#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tracking/patch/association_table.hpp"
#include "tracking/patch/simd8.hpp"

namespace evo::tracking {

/// Offset of the first cell of the plane of each of eight events: 0, or `negative_offset` for a negative polarity.
EVO_INLINE void FindPlaneOffsets(std::span<const std::int8_t> polarity, std::size_t begin, std::int32_t negative_offset,
                                 std::int32_t* offsets) {
  if (begin + kLanes <= polarity.size()) {
    for (int i = 0; i < kLanes; ++i) offsets[i] = polarity[begin + i] < 0 ? negative_offset : 0;
    return;
  }
  for (int i = 0; i < kLanes; ++i) {
    offsets[i] = begin + i < polarity.size() && polarity[begin + i] < 0 ? negative_offset : 0;
  }
}

/// AssociationTable::Interpolate of eight events at (u, v): one column for each part of the association. It blends rows
/// before columns, since two neighbouring cells fill one load; so it is not InterpolateBilinear.
EVO_INLINE void InterpolateAssociations(const AssociationTable& table, const F32x8& u, const F32x8& v,
                                        const std::int32_t* plane_offsets, Columns8* associations) {
  const auto radius = static_cast<float>(table.radius());
  const auto side = static_cast<float>(table.side());
  const F32x8 zero{};
  const F32x8 last = zero + (side - 1.0f);
  // An event outside is moved to the edge, where the table is zero.
  F32x8 column = u + radius;
  F32x8 row = v + radius;
  column = column > zero ? column : zero;
  column = column < last ? column : last;
  row = row > zero ? row : zero;
  row = row < last ? row : last;
  Cells8 cells;
  FindCells(column, row, side, &cells);
  F32x4 at[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const float* const upper = table.cells()[plane_offsets[i] + cells.index[i]].data();
    F32x8 two, lower;
    Load(upper, &two);
    Load(upper + 4 * table.side(), &lower);
    two += cells.fy[i] * (lower - two);
    F32x4 left, right;
    Split(two, &left, &right);
    at[i] = left + cells.fx[i] * (right - left);
  }
  ToColumns(at, associations);
}

}  // namespace evo::tracking
