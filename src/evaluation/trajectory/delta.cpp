#include "evo/evaluation/delta.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>
#include <sstream>
#include <utility>

#include "evo/core/error.hpp"

namespace evo::evaluation {

namespace {

constexpr std::pair<const char*, DeltaUnit> kUnits[] = {{"f", DeltaUnit::kFrames},
                                                        {"m", DeltaUnit::kMetres},
                                                        {"deg", DeltaUnit::kDegrees},
                                                        {"rad", DeltaUnit::kRadians},
                                                        {"s", DeltaUnit::kSeconds}};

Delta ParseDelta(const std::string& text) {
  Delta delta;
  const char* const end = text.data() + text.size();
  const auto [suffix, failure] = std::from_chars(text.data(), end, delta.value);
  const auto* const unit = std::ranges::find(kUnits, std::string(suffix, end), [](const auto& u) { return u.first; });
  if (failure == std::errc() && unit != std::end(kUnits)) {
    delta.unit = unit->second;
    delta.name = text;
    const double max = delta.unit == DeltaUnit::kDegrees   ? 180.0
                       : delta.unit == DeltaUnit::kRadians ? std::numbers::pi
                                                           : 1e6;
    const bool whole = delta.unit != DeltaUnit::kFrames || delta.value == std::floor(delta.value);
    if (delta.value > 0.0 && delta.value <= max && whole) return delta;
  }
  throw Error(ErrorKind::kUsage, "'" + text +
                                     "' is not a distance between poses; give a positive number and a unit, such as "
                                     "10f (whole frames), 1s, 10m, 5deg or 0.1rad, up to 180 degrees");
}

}  // namespace

const char* UnitName(DeltaUnit unit) {
  return std::ranges::find(kUnits, unit, [](const auto& u) { return u.second; })->first;
}

std::vector<Delta> ParseDeltas(const std::string& text) {
  std::vector<Delta> deltas;
  std::istringstream list(text);
  for (std::string name; std::getline(list, name, ',');) {
    const Delta delta = ParseDelta(name);
    if (std::ranges::find(deltas, name, &Delta::name) == deltas.end()) deltas.push_back(delta);
  }
  if (deltas.empty())
    throw Error(ErrorKind::kUsage, "the list of distances between poses is empty; give for example 1f,1s,10m");
  return deltas;
}

}  // namespace evo::evaluation
