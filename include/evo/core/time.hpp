#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace evo {

/// A stamp or a duration in nanoseconds, in the data set's own time base.
/// A double cannot hold an epoch stamp to better than 0.24 us; an int64 holds it exactly.
using TimeNs = std::int64_t;

inline constexpr TimeNs kNsPerSecond = 1'000'000'000;

constexpr double ToSeconds(TimeNs t) { return static_cast<double>(t) * 1e-9; }

/// Rounds to the nearest nanosecond. `seconds` is finite and below 9e9 in magnitude.
TimeNs FromSeconds(double seconds);

/// Parses a decimal number of seconds ("1504645177.420000123", "1.5e9"), exactly to the nanosecond if it has no
/// exponent; further decimals are rounded. Empty unless the whole text is a finite number below 9e9 in
/// magnitude.
std::optional<TimeNs> ParseTime(std::string_view text);

/// The exact number of seconds with nine decimals.
std::string FormatTime(TimeNs t);

}  // namespace evo
