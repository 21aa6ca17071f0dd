#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "evo/core/time.hpp"

namespace evo::events {

/// Events as columns of equal length, ordered by time (equal stamps are allowed).
struct EventColumns {
  std::vector<TimeNs> t;
  std::vector<std::uint16_t> x;       ///< px, raw sensor column
  std::vector<std::uint16_t> y;       ///< px, raw sensor row
  std::vector<std::int8_t> polarity;  ///< +1 brighter, -1 darker

  std::size_t size() const { return t.size(); }
  bool empty() const { return t.empty(); }
  void clear();
  void reserve(std::size_t count);
  void resize(std::size_t count);
  void push_back(TimeNs time, std::uint16_t column, std::uint16_t row, std::int8_t sign);
};

}  // namespace evo::events
