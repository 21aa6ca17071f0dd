#pragma once

#include <cstddef>

#include "evo/events/event_history.hpp"
#include "evo/tracking/density_map.hpp"
#include "tracking/lanes.hpp"

namespace evo {

/// Eight events of a patch.
struct EventLanes {
  Lanes x{}, y{}, dt{};
  std::int32_t plane[kLanes];  // where the cells of their polarity begin
};

/// Events from `begin` on; where there are no more, some that lie outside every map. `second`: where the cells of
/// negative events begin.
EVO_INLINE void Load(const LocalEvents& events, std::size_t begin, std::int32_t second, EventLanes* lanes) {
  const std::size_t count = events.size();
  if (begin + kLanes <= count) {
    Load(events.x.data() + begin, &lanes->x);
    Load(events.y.data() + begin, &lanes->y);
    Load(events.dt.data() + begin, &lanes->dt);
    for (int i = 0; i < kLanes; ++i) lanes->plane[i] = events.polarity[begin + i] < 0 ? second : 0;
    return;
  }
  for (int i = 0; i < kLanes; ++i) {
    const bool is_event = begin + i < count;
    lanes->x[i] = is_event ? events.x[begin + i] : 1e6f;
    lanes->y[i] = is_event ? events.y[begin + i] : 1e6f;
    lanes->dt[i] = is_event ? events.dt[begin + i] : 0.0f;
    lanes->plane[i] = is_event && events.polarity[begin + i] < 0 ? second : 0;
  }
}

/// AssociationField::At of eight events at (u, v), a column for each part of the pull.
EVO_INLINE void PullsAt(const AssociationField& field, const Lanes& u, const Lanes& v, const std::int32_t* plane,
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
  const Lanes c = __builtin_convertvector(__builtin_convertvector(column, LaneInts), Lanes);
  const Lanes r = __builtin_convertvector(__builtin_convertvector(row, LaneInts), Lanes);
  const Lanes fx = column - c;
  const Lanes fy = row - r;
  const LaneInts cell = __builtin_convertvector(r * side + c, LaneInts);
  FourLanes at[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const float* const above = field.table()[plane[i] + cell[i]].data();
    Lanes two, below;
    Load(above, &two);
    Load(above + 4 * field.side(), &below);
    two += fy[i] * (below - two);
    FourLanes left, right;
    Split(two, &left, &right);
    at[i] = left + fx[i] * (right - left);
  }
  ToColumns(at, pulls);
}

}  // namespace evo
