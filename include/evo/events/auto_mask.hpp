#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "evo/core/parameters.hpp"
#include "evo/events/event_reader.hpp"

namespace evo::events {

struct AutoMaskOptions {
  int slices = 40;
  double slice_s = 0.5;
  double max_crossing_ratio = 0.3;
  double min_area_ratio = 0.01;
};

/// Adds `events.auto_mask.*`.
void Register(Parameters& parameters, AutoMaskOptions& options);

/// The part of the image that does not belong to the scene: the bonnet of the camera's own car, a frame, a rig.
struct AutoMask {
  std::vector<std::uint8_t> masked;  ///< height x width, row-major: 1 where events are ignored; empty: nowhere
  double area_ratio = 0.0;           ///< masked pixels over all pixels
  std::string summary;               ///< "12.3 % of the sensor (bottom 44 rows)", or "nothing: " and the reason
};

/// Opens an interval of a recording. Throws Error (kNothingToDo) if it has no events.
using OpenInterval = std::function<std::unique_ptr<EventReader>(const Interval&)>;

/// Finds the part of the image that does not belong to the scene, in slices spread evenly over `interval`.
///
/// The scene flows through the image of a camera that looks ahead while it drives, outwards from the focus of
/// expansion: an edge passes one pixel, then, with the same polarity, the next one outwards. Where it always vanishes
/// at the same place although it flows towards it, something that is fixed to the camera covers the scene. That the
/// covering part is empty or moves itself (a bonnet mirrors the scene) does not matter. Lines along the flow (lanes,
/// kerbs, roof lines) rest in the image of a straight drive too, but the scene does not flow across them, which makes
/// them no evidence. See FixedEdge for the decision.
///
/// Memory is that of the sensor. Throws Error as the readers do.
AutoMask FindAutoMask(const OpenInterval& open, const Interval& interval, int width, int height,
                      const AutoMaskOptions& options);

}  // namespace evo::events
