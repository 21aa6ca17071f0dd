#pragma once

#include <cstdint>
#include <cstring>
#include <span>

// A function that is compiled twice, for any processor and for those that take eight floats at a time; which of the two
// runs is found out when the program is loaded, before a sanitizer is ready for it.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define EVO_HOT __attribute__((target_clones("avx2", "default")))
#else
#define EVO_HOT
#endif
#define EVO_INLINE inline __attribute__((always_inline))

namespace evo::tracking {

/// Eight floats that are computed at once. The lanes do not mix, so that the result does not depend on how many of them
/// a processor takes at a time.
using Lanes = float __attribute__((vector_size(32)));
using LaneInts = std::int32_t __attribute__((vector_size(32)));
using FourLanes = float __attribute__((vector_size(16)));
inline constexpr int kLanes = 8;

// Never by value: functions that are not inlined could not agree on how such a value is passed.

EVO_INLINE void Load(const float* from, Lanes* lanes) { std::memcpy(lanes, from, sizeof(Lanes)); }
/// Of a column from `begin` on, and `otherwise` where it has ended.
EVO_INLINE void Load(std::span<const float> column, std::size_t begin, float otherwise, Lanes* lanes) {
  if (begin + kLanes <= column.size()) {
    Load(column.data() + begin, lanes);
    return;
  }
  *lanes = Lanes{};
  for (int i = 0; i < kLanes; ++i) (*lanes)[i] = begin + i < column.size() ? column[begin + i] : otherwise;
}
EVO_INLINE void Store(const Lanes& lanes, float* to) { std::memcpy(to, &lanes, sizeof(Lanes)); }

EVO_INLINE float Sum(const Lanes& a) { return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7])); }

/// The first and the last four.
EVO_INLINE void Split(const Lanes& lanes, FourLanes* first, FourLanes* last) {
  *first = __builtin_shufflevector(lanes, lanes, 0, 1, 2, 3);
  *last = __builtin_shufflevector(lanes, lanes, 4, 5, 6, 7);
}
EVO_INLINE void Join(const FourLanes& first, const FourLanes& last, Lanes* lanes) {
  *lanes = __builtin_shufflevector(first, last, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// Four rows of four become columns, or the reverse. By fours, for which every processor has the instructions.
EVO_INLINE void Transpose(FourLanes* a, FourLanes* b, FourLanes* c, FourLanes* d) {
  const FourLanes ab_low = __builtin_shufflevector(*a, *b, 0, 4, 1, 5);
  const FourLanes ab_high = __builtin_shufflevector(*a, *b, 2, 6, 3, 7);
  const FourLanes cd_low = __builtin_shufflevector(*c, *d, 0, 4, 1, 5);
  const FourLanes cd_high = __builtin_shufflevector(*c, *d, 2, 6, 3, 7);
  *a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  *b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  *c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  *d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

/// Cells of a map that lie above and to the left of eight places in it, and how far beyond them these are.
struct LaneCells {
  LaneInts index;
  Lanes fx, fy;
};

EVO_INLINE void FindCells(const Lanes& column, const Lanes& row, float width, LaneCells* cells) {
  const Lanes c = __builtin_convertvector(__builtin_convertvector(column, LaneInts), Lanes);
  const Lanes r = __builtin_convertvector(__builtin_convertvector(row, LaneInts), Lanes);
  cells->index = __builtin_convertvector(r * width + c, LaneInts);
  cells->fx = column - c;
  cells->fy = row - r;
}

/// Four columns of eight rows.
struct LaneColumns {
  Lanes a, b, c, d;
};

EVO_INLINE void ToColumns(FourLanes* rows, LaneColumns* columns) {
  Transpose(&rows[0], &rows[1], &rows[2], &rows[3]);
  Transpose(&rows[4], &rows[5], &rows[6], &rows[7]);
  Join(rows[0], rows[4], &columns->a);
  Join(rows[1], rows[5], &columns->b);
  Join(rows[2], rows[6], &columns->c);
  Join(rows[3], rows[7], &columns->d);
}

/// The eight rows, one after the other.
EVO_INLINE void StoreRows(const LaneColumns& columns, float* to) {
  FourLanes rows[kLanes];
  Split(columns.a, &rows[0], &rows[4]);
  Split(columns.b, &rows[1], &rows[5]);
  Split(columns.c, &rows[2], &rows[6]);
  Split(columns.d, &rows[3], &rows[7]);
  Transpose(&rows[0], &rows[1], &rows[2], &rows[3]);
  Transpose(&rows[4], &rows[5], &rows[6], &rows[7]);
  for (int i = 0; i < kLanes; ++i) std::memcpy(to + 4 * i, &rows[i], sizeof(FourLanes));
}

}  // namespace evo::tracking
