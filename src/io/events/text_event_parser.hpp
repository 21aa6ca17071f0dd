#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "evo/core/time.hpp"

namespace evo::io {

/// One line `t x y p` of a UZH events.txt.
struct TextEvent {
  TimeNs t = 0;
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int8_t polarity = 1;  ///< +1 brighter, -1 darker
};

/// Bytes that must be readable behind the text that ParseCommonLine is given.
inline constexpr std::size_t kParserMargin = 8;

/// Moves `p` over eight decimal digits and gives their value, or leaves both as they are. All eight at once: neighbours
/// are joined to pairs, pairs to fours, fours to the whole.
inline void ParseEightDigits(const char** p, std::uint64_t* value) {
  static_assert(std::endian::native == std::endian::little);
  std::uint64_t digits = 0;
  std::memcpy(&digits, *p, sizeof digits);
  digits ^= 0x3030303030303030;
  if (((digits + 0x7676767676767676) | digits) & 0x8080808080808080) return;  // a byte above 9
  digits = digits * 10 + (digits >> 8);
  digits = (digits & 0x00ff00ff00ff00ff) * 100 + ((digits >> 16) & 0x00ff00ff00ff00ff);
  *value = (digits & 0xffff) * 10000 + ((digits >> 32) & 0xffff);
  *p += sizeof digits;
}

/// Moves `p` over decimal digits, `value` growing by each; returns how many there were.
inline std::ptrdiff_t ParseDigits(const char** p, std::uint64_t* value) {
  const char* const start = *p;
  for (unsigned digit; (digit = static_cast<unsigned char>(**p) - unsigned{'0'}) < 10; ++*p) {
    *value = 10 * *value + digit;
  }
  return *p - start;
}

/// Reads the common writing of a line: one blank between fields, at most nine decimals, p 0, 1 or -1, ending in \n or
/// \r\n. Returns the start of the next line, or null for anything else, which ParseEventLine then judges. `p` must
/// point into text that ends with \n and kParserMargin more bytes: no other bound is checked. This is where the time
/// goes that reading a recording takes.
inline const char* ParseCommonLine(const char* p, TextEvent* event) {
  constexpr std::uint64_t kScale[] = {1000000000, 100000000, 10000000, 1000000, 100000, 10000, 1000, 100, 10, 1};
  constexpr std::uint64_t kLargestSeconds = 9000000000;
  constexpr std::ptrdiff_t kMostDigits = 9;
  std::uint64_t seconds = 0;
  std::uint64_t fraction = 0;
  std::uint64_t x = 0;
  std::uint64_t y = 0;
  const auto is_short = [](std::ptrdiff_t digits) { return digits > 0 && digits <= kMostDigits; };
  const std::ptrdiff_t digits = ParseDigits(&p, &seconds);
  if (digits == 0 || digits > kMostDigits + 1 || seconds >= kLargestSeconds) return nullptr;
  if (*p == '.') {
    const char* const start = ++p;
    ParseEightDigits(&p, &fraction);
    ParseDigits(&p, &fraction);
    if (p == start || p - start > kMostDigits) return nullptr;
    fraction *= kScale[p - start];
  }
  if (*p != ' ' || !is_short(ParseDigits(&++p, &x))) return nullptr;
  if (*p != ' ' || !is_short(ParseDigits(&++p, &y))) return nullptr;
  if (*p++ != ' ') return nullptr;
  const bool minus = *p == '-';
  p += minus;
  const unsigned one = static_cast<unsigned char>(*p++) - unsigned{'0'};
  if ((one > 1) | (minus & (one == 0))) return nullptr;
  event->polarity = static_cast<std::int8_t>(2 * static_cast<int>(one & !minus) - 1);
  if (*p == '\r') ++p;
  if (*p++ != '\n') return nullptr;
  event->t = static_cast<TimeNs>(seconds * 1000000000 + fraction);
  event->x = static_cast<std::int64_t>(x);
  event->y = static_cast<std::int64_t>(y);
  return p;
}

/// Reads any writing of a line, without its line end. Empty for a blank line or a comment (`#`); otherwise `fault` says
/// what is wrong, or is empty.
std::optional<TextEvent> ParseEventLine(std::string_view line, std::string* fault);

}  // namespace evo::io
