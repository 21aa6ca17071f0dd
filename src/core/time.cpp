#include "evo/core/time.hpp"

#include <charconv>
#include <cmath>

namespace evo {

namespace {

constexpr double kMaxSeconds = 9e9;  // int64 holds 9.2e9 s in nanoseconds

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

TimeNs FromSeconds(double seconds) {
  const double whole = std::floor(seconds);
  return static_cast<TimeNs>(whole) * kNsPerSecond + std::llround((seconds - whole) * 1e9);
}

std::optional<TimeNs> ParseTime(std::string_view text) {
  const char* p = text.data();
  const char* const end = p + text.size();
  const bool negative = p != end && *p == '-';
  if (negative) ++p;

  TimeNs whole = 0;
  int digits = 0;
  for (; p != end && IsDigit(*p); ++p, ++digits) {
    if (digits >= 10) return std::nullopt;
    whole = whole * 10 + (*p - '0');
  }
  TimeNs fraction = 0;
  int decimals = 0;
  bool round_up = false;
  if (p != end && *p == '.') {
    for (++p; p != end && IsDigit(*p); ++p, ++decimals) {
      if (decimals < 9) fraction = fraction * 10 + (*p - '0');
      if (decimals == 9) round_up = *p >= '5';
    }
  }
  if (digits + decimals == 0) return std::nullopt;
  if (p != end) {
    double seconds = 0.0;
    // NOLINTNEXTLINE(bugprone-suspicious-stringview-data-usage): `end` bounds it.
    const auto [last, error] = std::from_chars(text.data(), end, seconds);
    if (error != std::errc() || last != end || !(std::abs(seconds) < kMaxSeconds)) return std::nullopt;
    return FromSeconds(seconds);
  }
  if (static_cast<double>(whole) >= kMaxSeconds) return std::nullopt;
  for (int i = decimals; i < 9; ++i) fraction *= 10;
  const TimeNs t = whole * kNsPerSecond + fraction + (round_up ? 1 : 0);
  return negative ? -t : t;
}

std::string FormatTime(TimeNs t) {
  constexpr std::size_t kDecimals = 9;
  const auto magnitude = t < 0 ? 0 - static_cast<std::uint64_t>(t) : static_cast<std::uint64_t>(t);
  std::string text = std::to_string(magnitude);
  if (text.size() <= kDecimals) text.insert(0, kDecimals + 1 - text.size(), '0');
  text.insert(text.size() - kDecimals, 1, '.');
  return t < 0 ? "-" + text : text;
}

}  // namespace evo
