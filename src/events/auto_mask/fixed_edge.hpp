#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "events/auto_mask/structure_flow.hpp"

namespace evo::events {

/// A point of the image seen from a side (px).
struct SidePoint {
  double along = 0.0;
  double depth = 0.0;
};

/// Where the focus of expansion may be: the motions of the image leave more than one place.
struct FocusOfExpansion {
  SidePoint middle;
  std::vector<SidePoint> places;
};

/// Finds the focus of expansion, as seen from the bottom. An edge shows only the part of its motion that is normal to
/// itself; this part leads away from the focus all the same (Negahdaripour and Horn, A direct method for locating the
/// focus of expansion, CVGIP 1989). Empty, with the `reason`, if too little moves or if not nearly all of it moves away
/// from one place.
std::optional<FocusOfExpansion> FindFocusOfExpansion(const StructureFlow& flow, std::string* reason);

/// The edge of something that is fixed to the camera and covers the image from one side.
struct FixedEdge {
  std::vector<int> first;  ///< by block: depth of the first covered pixel; the view's depth: none
  double area = 0.0;       ///< covered pixels
};

/// What is required of a fixed edge.
struct FixedEdgeCriterion {
  double max_crossing_ratio = 0.3;
  double min_area = 0.0;  ///< px
};

/// Finds the edge of what covers the image from the side of `view`, the sum of the `parts`. Of the curve across which
/// the least structure passes, it is required that
/// - structure flows across it, to it or from it, wherever the focus is: in a fifth of its blocks,
/// - hardly any structure passes in these blocks, in every part of the recording,
/// - structure passes at hardly any other place of it,
/// - it covers enough, and less than half of the image.
std::optional<FixedEdge> FindFixedEdge(const SideView& view, std::span<const SideView> parts,
                                       const FocusOfExpansion& focus, const FixedEdgeCriterion& criterion);

}  // namespace evo::events
