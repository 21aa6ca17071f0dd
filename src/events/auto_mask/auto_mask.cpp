#include "evo/events/auto_mask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include "events/auto_mask/fixed_edge.hpp"
#include "evo/core/error.hpp"

namespace evo::events {

namespace {

constexpr double kMinSpan = 2.0;  // s: what rests for less may be part of the scene
constexpr int kMargin = 1;        // px: the pixels at the edge see both sides of it

constexpr std::array<std::pair<ImageSide, const char*>, 4> kSides = {{{ImageSide::kBottom, "bottom {} rows"},
                                                                      {ImageSide::kTop, "top {} rows"},
                                                                      {ImageSide::kLeft, "left {} columns"},
                                                                      {ImageSide::kRight, "right {} columns"}}};

AutoMask Nothing(const std::string& reason) { return {{}, 0.0, "nothing: " + reason}; }

/// The slices of `interval` of a recording of `end` ns that are read.
std::vector<Interval> Slices(const Interval& interval, TimeNs end, const AutoMaskOptions& options) {
  const TimeNs to = std::min(end, interval.to.value_or(end));
  const TimeNs slice = FromSeconds(options.slice_s);
  const TimeNs span = to - interval.from;
  if (span <= options.slices * slice) return {{interval.from, interval.to}};
  std::vector<Interval> slices;
  for (int i = 0; i < options.slices; ++i) {
    const TimeNs from = interval.from + (span - slice) / std::max(1, options.slices - 1) * i;
    slices.push_back({from, from + slice});
  }
  return slices;
}

/// The reader of a slice; none if it has no events.
std::unique_ptr<EventReader> OpenSlice(const OpenInterval& open, const Interval& slice) {
  try {
    return open(slice);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kNothingToDo) throw;
    return nullptr;
  }
}

/// A point seen from the bottom, seen from `side`.
SidePoint SeenFrom(ImageSide side, const SidePoint& point, const StructureFlow& flow) {
  switch (side) {
    case ImageSide::kBottom:
      return point;
    case ImageSide::kTop:
      return {point.along, flow.height() - 1 - point.depth};
    case ImageSide::kLeft:
      return {point.depth, flow.width() - 1 - point.along};
    default:
      return {point.depth, point.along};
  }
}

FocusOfExpansion SeenFrom(ImageSide side, FocusOfExpansion focus, const StructureFlow& flow) {
  focus.middle = SeenFrom(side, focus.middle, flow);
  for (SidePoint& place : focus.places) place = SeenFrom(side, place, flow);
  return focus;
}

/// Masks what is covered from `side`.
void Cover(ImageSide side, const FixedEdge& edge, const SideView& view, int width, std::vector<std::uint8_t>* masked) {
  for (int along = 0; along < view.length; ++along) {
    const int first = edge.first[view.BlockAt(along)];
    if (first == view.depth) continue;
    for (int d = first - kMargin; d < view.depth; ++d) {
      const bool is_horizontal = side == ImageSide::kBottom || side == ImageSide::kTop;
      const int place = side == ImageSide::kBottom || side == ImageSide::kRight ? d : view.depth - 1 - d;
      (*masked)[static_cast<std::size_t>(is_horizontal ? place * width + along : along * width + place)] = 1;
    }
  }
}

AutoMask Decide(const StructureFlow& flow, const AutoMaskOptions& options) {
  std::string reason;
  const auto focus = FindFocusOfExpansion(flow, &reason);
  if (!focus) return Nothing(reason);
  const auto pixels = static_cast<std::size_t>(flow.width()) * static_cast<std::size_t>(flow.height());
  const FixedEdgeCriterion criterion{options.max_crossing_ratio, options.min_area_ratio * static_cast<double>(pixels)};
  AutoMask mask;
  std::string places;
  for (const auto& [side, place] : kSides) {
    const SideView view = flow.From(side);
    std::vector<SideView> parts;
    for (int part = 0; part < StructureFlow::kParts; ++part) parts.push_back(flow.From(side, part));
    const auto edge = FindFixedEdge(view, parts, SeenFrom(side, *focus, flow), criterion);
    if (!edge) continue;
    mask.masked.resize(pixels);
    Cover(side, *edge, view, flow.width(), &mask.masked);
    const int covered = view.depth - *std::ranges::min_element(edge->first) + kMargin;
    places += (places.empty() ? "" : ", ") + fmt::format(fmt::runtime(place), covered);
  }
  if (places.empty()) return Nothing("there is no edge at which the scene vanishes all over the run");
  mask.area_ratio = static_cast<double>(std::ranges::count(mask.masked, 1)) / static_cast<double>(pixels);
  mask.summary = fmt::format("{:.1f} % of the sensor ({})", 100.0 * mask.area_ratio, places);
  return mask;
}

}  // namespace

void Register(Parameters& parameters, AutoMaskOptions& o) {
  parameters.Add("events.auto_mask.slices", &o.slices, 4, 1000,
                 "number of slices of the recording that --mask auto reads");
  parameters.Add("events.auto_mask.slice_s", &o.slice_s, 0.05, 60.0, "length of such a slice (s)");
  parameters.Add("events.auto_mask.max_crossing_ratio", &o.max_crossing_ratio, 0.0, 0.5,
                 "maximum ratio of the structure across the edge of a masked region to that before it");
  parameters.Add("events.auto_mask.min_area_ratio", &o.min_area_ratio, 0.0, 0.5,
                 "minimum area of a masked region over that of the sensor");
}

AutoMask FindAutoMask(const OpenInterval& open, const Interval& interval, int width, int height,
                      const AutoMaskOptions& options) {
  StructureFlow flow(width, height);
  TimeNs start = 0;
  TimeNs end = 0;
  {
    const auto whole = open(interval);
    start = whole->first_stamp();
    end = whole->last_stamp() + 1 - start;
  }
  const TimeNs span = std::min(end, interval.to.value_or(end)) - interval.from;
  if (ToSeconds(span) < kMinSpan) return Nothing(fmt::format("{:.1f} s are too short to tell", ToSeconds(span)));
  EventColumns block;
  for (const Interval& slice : Slices(interval, end, options)) {
    const auto reader = OpenSlice(open, slice);
    while (reader && reader->Next(&block)) {
      const TimeNs middle = block.t[block.size() / 2] - start - interval.from;
      flow.Add(block, static_cast<int>(
                          std::clamp<TimeNs>(middle * StructureFlow::kParts / span, 0, StructureFlow::kParts - 1)));
    }
  }
  return Decide(flow, options);
}

}  // namespace evo::events
