#include "io/events/text_event_parser.hpp"

#include <vector>

#include "io/text_lines.hpp"

namespace evo::io {

std::optional<TextEvent> ParseEventLine(std::string_view line, std::string* fault) {
  fault->clear();
  line = Trim(line);
  if (line.empty() || line.front() == '#') return std::nullopt;
  const std::vector<std::string_view> fields = SplitFields(line);
  if (fields.size() != 4) {
    *fault = "expected 't x y p', found " + Quote(line);
    return std::nullopt;
  }
  const auto t = ParseTime(fields[0]);
  const auto x = ParseInteger(fields[1]);
  const auto y = ParseInteger(fields[2]);
  const auto p = ParseInteger(fields[3]);
  if (!t) {
    *fault = "the stamp " + Quote(fields[0]) + " is not a time in seconds";
  } else if (!x || !y) {
    *fault = "the pixel " + Quote(fields[x ? 2 : 1]) + " is not a whole number";
  } else if (!p || *p < -1 || *p > 1) {
    *fault = "the polarity " + Quote(fields[3]) + " is none of -1, 0 and 1";
  } else {
    return TextEvent{*t, *x, *y, static_cast<std::int8_t>(*p == 1 ? 1 : -1)};
  }
  return std::nullopt;
}

}  // namespace evo::io
