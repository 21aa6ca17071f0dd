#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evo/core/random.hpp"

namespace evo::simulation {

/// What a value of a scene is drawn from, as text:
///   day                          always this value
///   0.1..0.5                     uniform
///   0.05..5 log                  uniform in the logarithm
///   0..3 whole                   a whole number, both ends included
///   0.7..4 log of sensor.x       such a number times the value of sensor.x; also a number alone: 0.5 of sensor.x
///   0 * 2 | 0.5..4 | 10          one of these, the first twice as often as each of the others
class RandomValue {
 public:
  /// Nothing if `text` is not of this form.
  static std::optional<RandomValue> Parse(std::string_view text);

  /// The present value of another parameter, as text.
  using Lookup = std::function<std::string(const std::string& name)>;
  /// Draws a value; numbers have four digits. Throws std::invalid_argument with the name of a parameter behind `of`
  /// that is no number.
  std::string Draw(Random random, const Lookup& lookup) const;

 private:
  struct Option {
    double weight = 1.0;
    std::string literal;  ///< unless it is a range
    bool is_range = false;
    double low = 0.0;
    double high = 0.0;
    bool log = false;
    bool whole = false;
    std::string factor;  ///< name of a parameter; empty: none
  };
  static std::optional<Option> ParseOption(std::string_view text);
  static double DrawNumber(const Option& option, Random* random);

  std::vector<Option> options_;
};

/// An index with a chance in proportion to its weight; the weights are not all 0.
std::size_t DrawIndex(const std::vector<double>& weights, Random* random);

}  // namespace evo::simulation
