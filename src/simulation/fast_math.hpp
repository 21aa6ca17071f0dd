#pragma once

#include <bit>
#include <cstdint>

namespace evo::simulation {

// Elementary functions without branches and tables: loops over pixels become vector code, and results are the same on
// every machine, whatever its mathematical library.

/// log(x) for x in [1e-37, 3e38] with an error of 1e-6 + 1e-7 |log(x)|. With x = 2^e m it is e log(2) + log(m), where
/// log(m) = 2 artanh((m - 1) / (m + 1)) is a series.
inline float FastLog(float x) {
  constexpr std::int32_t kHalfRoot = 0x3F3504F3;  // sqrt(1/2): m in [sqrt(1/2), sqrt(2))
  const auto bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - kHalfRoot) >> 23;
  const float m = std::bit_cast<float>(bits - exponent * (1 << 23));
  const float z = (m - 1.0F) / (m + 1.0F);
  const float z2 = z * z;
  const float series = z * (2.0F + z2 * (2.0F / 3.0F + z2 * (2.0F / 5.0F + z2 * (2.0F / 7.0F))));
  return static_cast<float>(exponent) * 0.69314718F + series;
}

/// log2(x) of a positive, normal number with an error of 0.01; continuous.
inline float FastLog2(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const float m = std::bit_cast<float>((bits & 0x007FFFFFU) | 0x3F800000U);
  const auto exponent = static_cast<float>(static_cast<int>(bits >> 23) - 127);
  return exponent + (2.0F - m * (1.0F / 3.0F)) * m - 5.0F / 3.0F;
}

/// 1 - exp(-x) for x >= 0 (infinity included) with a relative error below 1e-6: the step response of a low-pass after x
/// time constants. With x = k log(2) - r and |r| <= log(2) / 2, exp(r) - 1 is a series.
inline float FastOneMinusExp(float x) {
  const float bounded = x < 80.0F ? x : 80.0F;
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): never negative, and any near k will do.
  const auto k = static_cast<std::int32_t>(bounded * 1.44269504F + 0.5F);
  const auto whole = static_cast<float>(k);
  const float r = (whole * 0.693359375F - bounded) - whole * 2.12194440e-4F;  // log(2) in two parts
  const float series =
      r * (1.0F + r * (0.5F + r * (1.0F / 6.0F + r * (1.0F / 24.0F + r * (1.0F / 120.0F + r * (1.0F / 720.0F))))));
  const float scale = std::bit_cast<float>((127 - k) * (1 << 23));
  return (1.0F - scale) - scale * series;
}

}  // namespace evo::simulation
