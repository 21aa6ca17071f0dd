#pragma once

#include "events/auto_mask/fixed_edge.hpp"
#include "events/auto_mask/structure_flow.hpp"

namespace evo::events {

/// Structure on one side of a place in a block and across that place. Structure that passes is as strong across it.
class EdgeCrossing {
 public:
  static constexpr int kSideLinks = 6;  // px in which the structure beside the place is measured
  static constexpr double kMaxNoise = 0.25;

  /// Structure before the place, from where the flow comes.
  static EdgeCrossing From(const SideView& view, int block, int d);
  /// Structure beyond the place, towards the side.
  static EdgeCrossing Into(const SideView& view, int block, int d);

  void Add(const EdgeCrossing& other) {
    beside_.Add(other.beside_);
    across_.Add(other.across_);
  }
  bool HasStructure() const;
  bool IsOutward() const;
  /// Structure across the place over that beside it: 1 where it passes, 0 where it vanishes or appears.
  double Ratio() const;
  /// Standard deviation of the ratio where nothing passes.
  double Noise() const;

 private:
  LinkFlow beside_;
  LinkFlow across_;
};

/// Whether flow from `focus` crosses an edge of this slope, at an angle of more than 14 degrees.
bool IsCrossed(const SidePoint& focus, int block, int d, double slope);

}  // namespace evo::events
