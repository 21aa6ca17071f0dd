#include "evo/core/number.hpp"

#include <array>
#include <charconv>

namespace evo {

std::string FormatNumber(double value) {
  std::array<char, 32> text{};  // the longest, -2.2250738585072014e-308, has 24
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace evo
