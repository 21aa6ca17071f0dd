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

/// Bytes that must be readable after the text given to ParseCommonLine.
inline constexpr std::size_t kParserMargin = 8;

/// Moves `p` over eight decimal digits and sets `value`, or leaves both as they are. The digits are joined in parallel
/// to pairs, the pairs to fours and the fours to the whole (D. Lemire: Quickly parsing eight digits, 2018).
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

/// Moves `p` over decimal digits, appends them to `value` and returns their number.
inline std::ptrdiff_t ParseDigits(const char** p, std::uint64_t* value) {
  const char* const start = *p;
  for (unsigned digit; (digit = static_cast<unsigned char>(**p) - unsigned{'0'}) < 10; ++*p) {
    *value = 10 * *value + digit;
  }
  return *p - start;
}

/// Parses a line in its common form: one blank between fields, at most nine decimals, p 0, 1 or -1, ending in \n or
/// \r\n. Returns the start of the next line, or null for any other line, which ParseEventLine then parses. `p` must
/// point into text that ends with \n and kParserMargin more bytes: no other bound is checked. Reading a text recording
/// spends most of its time here.
inline const char* ParseCommonLine(const char* p, TextEvent* event) {
  constexpr std::uint64_t kScale[] = {1000000000, 100000000, 10000000, 1000000, 100000, 10000, 1000, 100, 10, 1};
  constexpr std::uint64_t kMaxSeconds = 9000000000;
  constexpr std::ptrdiff_t kMaxDigits = 9;
  std::uint64_t seconds = 0;
  std::uint64_t fraction = 0;
  std::uint64_t x = 0;
  std::uint64_t y = 0;
  const auto is_short = [](std::ptrdiff_t digits) { return digits > 0 && digits <= kMaxDigits; };
  const std::ptrdiff_t digits = ParseDigits(&p, &seconds);
  if (digits == 0 || digits > kMaxDigits + 1 || seconds >= kMaxSeconds) return nullptr;
  if (*p == '.') {
    const char* const start = ++p;
    ParseEightDigits(&p, &fraction);
    ParseDigits(&p, &fraction);
    if (p == start || p - start > kMaxDigits) return nullptr;
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

/// Parses a line in any form, without its line end. Empty for a blank line, a comment (`#`) or a faulty line; `fault`
/// describes the fault and is empty otherwise.
std::optional<TextEvent> ParseEventLine(std::string_view line, std::string* fault);

}  // namespace evo::io
