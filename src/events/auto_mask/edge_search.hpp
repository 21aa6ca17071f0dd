#pragma once

#include <vector>

#include "events/auto_mask/fixed_edge.hpp"
#include "events/auto_mask/structure_flow.hpp"

namespace evo::events {

/// Finds the place where an edge that covers the image from one side would be: the parabola along the side across which
/// the least structure passes. A bonnet and a frame are smooth; a free shape would follow the gaps of any texture.
class EdgeSearch {
 public:
  static constexpr int kTolerance = 1;    // px by which an edge may differ from its curve
  static constexpr int kFirstDepth = 12;  // px

  EdgeSearch(const SideView& view, const SidePoint& focus);

  /// By block: the depth of the first covered pixel.
  std::vector<int> Find() const;

 private:
  /// depth = offset + tilt u + bend u^2 (px), where u goes from -1 to 1 along the side.
  struct Curve {
    double offset = 0.0;
    double tilt = 0.0;
    double bend = 0.0;

    double Depth(double u) const { return offset + (tilt + bend * u) * u; }
  };
  /// The best curve within a range and its score.
  struct Best {
    Curve curve;
    double score = 0.0;
  };
  struct Range {
    Curve from;
    Curve to;
    Curve step;
  };
  /// What a place says about an edge there: from -0.5, structure passes it, to 0.5, none does.
  struct Score {
    float value = 0.0F;
    bool is_outward = false;  // the flow
  };

  static Score ScoreAt(const SideView& view, int block, int d);
  Best FindIn(const Range& range, int tolerance) const;
  double Sum(const Curve& curve, int tolerance) const;
  /// The best score near `d`; none outside the image.
  Score BestNear(int block, int d, int tolerance) const;
  double Along(int block) const { return (block + 0.5) * 2.0 / blocks_ - 1.0; }

  SidePoint focus_;
  int blocks_;
  int depth_;
  std::vector<Score> scores_;  // blocks x depth
};

}  // namespace evo::events
