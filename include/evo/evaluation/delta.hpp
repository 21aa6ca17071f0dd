#pragma once

#include <string>
#include <vector>

namespace evo::evaluation {

enum class DeltaUnit { kFrames, kMetres, kDegrees, kRadians, kSeconds };

/// Distance between the two poses of a relative pose error.
struct Delta {
  double value = 1.0;
  DeltaUnit unit = DeltaUnit::kFrames;
  std::string name = "1f";  ///< as the user wrote it
};

/// "f", "m", "deg", "rad", "s".
const char* UnitName(DeltaUnit unit);

/// Parses a comma-separated list such as "1f,0.5s,10m,5deg,0.1rad". Deltas are positive, whole numbers of frames, and
/// at most 180 degrees. Throws Error (kUsage).
std::vector<Delta> ParseDeltas(const std::string& text);

}  // namespace evo::evaluation
