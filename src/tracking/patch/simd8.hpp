#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

// Compiles a function twice: for any processor and for those with AVX2, which take eight floats at a time. The loader
// chooses one of the two when the program starts, before a sanitizer is ready for it.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define EVO_HOT __attribute__((target_clones("avx2", "default")))
#else
#define EVO_HOT
#endif
#define EVO_INLINE inline __attribute__((always_inline))

namespace evo::tracking {

/// Eight floats (lanes) that are computed at once. Lanes do not mix, so the result does not depend on how many of them
/// a processor takes at a time.
using F32x8 = float __attribute__((vector_size(32)));
using I32x8 = std::int32_t __attribute__((vector_size(32)));
using F32x4 = float __attribute__((vector_size(16)));
inline constexpr int kLanes = 8;

// No function takes or returns a vector by value: processors differ in how they pass one.

EVO_INLINE void Load(const float* from, F32x8* to) { std::memcpy(to, from, sizeof(F32x8)); }
/// Loads the elements from `begin` on, and `padding` beyond the last one.
EVO_INLINE void Load(std::span<const float> from, std::size_t begin, float padding, F32x8* to) {
  if (begin + kLanes <= from.size()) {
    Load(from.data() + begin, to);
    return;
  }
  *to = F32x8{};
  for (int i = 0; i < kLanes; ++i) (*to)[i] = begin + i < from.size() ? from[begin + i] : padding;
}
EVO_INLINE void Store(const F32x8& from, float* to) { std::memcpy(to, &from, sizeof(F32x8)); }

EVO_INLINE float Sum(const F32x8& a) { return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7])); }

/// Natural logarithm of positive normal numbers, with an error of at most 2e-4.
EVO_INLINE void Log(const F32x8& x, F32x8* logarithm) {
  I32x8 bits;
  std::memcpy(&bits, &x, sizeof(bits));
  const F32x8 exponent = __builtin_convertvector((bits >> 23) - 127, F32x8);
  bits = (bits & 0x7fffff) | 0x3f800000;
  F32x8 mantissa;  // in [1, 2)
  std::memcpy(&mantissa, &bits, sizeof(mantissa));
  // The polynomial of degree 4 that deviates least from the base-2 logarithm at its Chebyshev nodes.
  const F32x8 log2 =
      exponent +
      ((((-0.0784406762f * mantissa + 0.626032182f) * mantissa + -2.07833517f) * mantissa + 4.02921139f) * mantissa +
       -2.49835315f);
  *logarithm = 0.69314718f * log2;
}

/// Splits eight lanes into the first and the last four.
EVO_INLINE void Split(const F32x8& all, F32x4* first, F32x4* last) {
  *first = __builtin_shufflevector(all, all, 0, 1, 2, 3);
  *last = __builtin_shufflevector(all, all, 4, 5, 6, 7);
}
EVO_INLINE void Join(const F32x4& first, const F32x4& last, F32x8* all) {
  *all = __builtin_shufflevector(first, last, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// Transposes a 4 x 4 matrix. Four lanes are used, since every processor has the instructions for them.
EVO_INLINE void Transpose(F32x4* a, F32x4* b, F32x4* c, F32x4* d) {
  const F32x4 ab_low = __builtin_shufflevector(*a, *b, 0, 4, 1, 5);
  const F32x4 ab_high = __builtin_shufflevector(*a, *b, 2, 6, 3, 7);
  const F32x4 cd_low = __builtin_shufflevector(*c, *d, 0, 4, 1, 5);
  const F32x4 cd_high = __builtin_shufflevector(*c, *d, 2, 6, 3, 7);
  *a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  *b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  *c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  *d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

/// BilinearCell of eight places at once.
struct Cells8 {
  I32x8 index;   ///< of the upper left cell
  F32x8 fx, fy;  ///< from it to the right and down, in [0, 1)
};

/// Finds the cells of places at `column`, `row` >= 0 in a grid whose rows have `width` cells.
EVO_INLINE void FindCells(const F32x8& column, const F32x8& row, float width, Cells8* cells) {
  const F32x8 c = __builtin_convertvector(__builtin_convertvector(column, I32x8), F32x8);
  const F32x8 r = __builtin_convertvector(__builtin_convertvector(row, I32x8), F32x8);
  cells->index = __builtin_convertvector(r * width + c, I32x8);
  cells->fx = column - c;
  cells->fy = row - r;
}

/// A matrix of eight rows and four columns.
struct Columns8 {
  F32x8 a, b, c, d;
};

/// Converts eight rows of four to columns.
EVO_INLINE void ToColumns(F32x4* rows, Columns8* columns) {
  Transpose(&rows[0], &rows[1], &rows[2], &rows[3]);
  Transpose(&rows[4], &rows[5], &rows[6], &rows[7]);
  Join(rows[0], rows[4], &columns->a);
  Join(rows[1], rows[5], &columns->b);
  Join(rows[2], rows[6], &columns->c);
  Join(rows[3], rows[7], &columns->d);
}

/// Stores the eight rows one after the other.
EVO_INLINE void StoreRows(const Columns8& columns, float* to) {
  F32x4 rows[kLanes];
  Split(columns.a, &rows[0], &rows[4]);
  Split(columns.b, &rows[1], &rows[5]);
  Split(columns.c, &rows[2], &rows[6]);
  Split(columns.d, &rows[3], &rows[7]);
  Transpose(&rows[0], &rows[1], &rows[2], &rows[3]);
  Transpose(&rows[4], &rows[5], &rows[6], &rows[7]);
  for (int i = 0; i < kLanes; ++i) std::memcpy(to + 4 * i, &rows[i], sizeof(F32x4));
}

}  // namespace evo::tracking
