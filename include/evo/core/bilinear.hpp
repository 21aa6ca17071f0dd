#pragma once

namespace evo {

/// The four cells of a grid around a position, and the position's offset from the first of them, in [0, 1) cells.
/// `Real` is float or double.
template <typename Real>
struct BilinearCell {
  int column;  ///< column of the upper left cell
  int row;     ///< row of the upper left cell
  Real fx;     ///< offset to the right
  Real fy;     ///< offset down

  /// The cells around the position `x`, `y` >= 0, in cells.
  BilinearCell(Real x, Real y)
      : column(static_cast<int>(x)),
        row(static_cast<int>(y)),
        fx(x - static_cast<Real>(column)),
        fy(y - static_cast<Real>(row)) {}
};

/// Interpolates between the values of the four cells. `upper` points to the upper left value, `lower` to the one below;
/// their right neighbours follow them in memory.
template <typename Real, typename Value>
Value InterpolateBilinear(const BilinearCell<Real>& cell, const Value* upper, const Value* lower) {
  const Value above = upper[0] + cell.fx * (upper[1] - upper[0]);
  const Value below = lower[0] + cell.fx * (lower[1] - lower[0]);
  return above + cell.fy * (below - above);
}

}  // namespace evo
