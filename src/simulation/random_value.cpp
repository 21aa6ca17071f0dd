#include "simulation/random_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "evo/core/number.hpp"

namespace evo::simulation {

namespace {

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::optional<double> ParseNumber(std::string_view text) {
  text = Trimmed(text);
  double value = 0.0;
  const auto [last, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || last != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

/// Takes what follows the last `separator` off `text`; empty: there is none.
std::string_view CutTail(std::string_view* text, std::string_view separator) {
  const std::size_t at = text->rfind(separator);
  if (at == std::string_view::npos) return {};
  const std::string_view tail = Trimmed(text->substr(at + separator.size()));
  *text = Trimmed(text->substr(0, at));
  return tail;
}

/// Takes the word off the end of `text` if it is there.
bool CutWord(std::string_view* text, std::string_view word) {
  if (!text->ends_with(word)) return false;
  text->remove_suffix(word.size());
  *text = Trimmed(*text);
  return true;
}

double RoundToFourDigits(double value) { return ParseNumber(fmt::format("{:.4g}", value)).value_or(value); }

}  // namespace

std::size_t DrawIndex(const std::vector<double>& weights, Random* random) {
  double left = random->Uniform() * std::accumulate(weights.begin(), weights.end(), 0.0);
  for (std::size_t i = 0; i + 1 < weights.size(); ++i) {
    left -= weights[i];
    if (left < 0.0) return i;
  }
  return weights.size() - 1;
}

std::optional<RandomValue> RandomValue::Parse(std::string_view text) {
  RandomValue value;
  if (text.empty()) {
    value.options_.push_back({});  // an empty text, such as no path
    return value;
  }
  while (true) {
    const std::size_t bar = std::min(text.find('|'), text.size());
    const auto option = ParseOption(Trimmed(text.substr(0, bar)));
    if (!option) return {};
    value.options_.push_back(*option);
    if (bar == text.size()) break;
    text.remove_prefix(bar + 1);
  }
  const bool possible = std::ranges::any_of(value.options_, [](const Option& option) { return option.weight > 0.0; });
  return possible ? std::optional(value) : std::nullopt;
}

std::optional<RandomValue::Option> RandomValue::ParseOption(std::string_view text) {
  Option option;
  if (const std::string_view weight = CutTail(&text, " * "); !weight.empty()) {
    const auto number = ParseNumber(weight);
    if (!number || *number < 0.0) return {};
    option.weight = *number;
  }
  option.literal = text;
  option.factor = CutTail(&text, " of ");
  option.log = CutWord(&text, " log");
  option.whole = CutWord(&text, " whole");
  const std::size_t dots = text.find("..");
  const auto low = ParseNumber(text.substr(0, dots));
  const auto high = dots == std::string_view::npos ? low : ParseNumber(text.substr(dots + 2));
  option.is_range = low && high;
  if (!option.is_range) {
    const bool plain = option.factor.empty() && !option.log && !option.whole && !option.literal.empty();
    return plain ? std::optional(option) : std::nullopt;
  }
  option.low = *low;
  option.high = *high;
  if (option.low > option.high || (option.log && option.low <= 0.0)) return {};
  return option;
}

double RandomValue::DrawNumber(const Option& option, Random* random) {
  if (option.whole) return std::floor(random->Uniform(std::ceil(option.low), std::floor(option.high) + 1.0));
  if (option.log) return std::exp(random->Uniform(std::log(option.low), std::log(option.high)));
  return random->Uniform(option.low, option.high);
}

std::string RandomValue::Draw(Random random, const Lookup& lookup) const {
  std::vector<double> weights;
  for (const Option& option : options_) weights.push_back(option.weight);
  const Option& option = options_[DrawIndex(weights, &random)];
  if (!option.is_range) return option.literal;
  if (option.low == option.high && option.factor.empty()) return option.literal;
  double number = DrawNumber(option, &random);
  if (!option.factor.empty()) {
    const auto factor = ParseNumber(lookup(option.factor));
    if (!factor) throw std::invalid_argument(option.factor);
    number *= *factor;
  }
  return FormatNumber(option.whole ? std::round(number) : RoundToFourDigits(number));
}

}  // namespace evo::simulation
