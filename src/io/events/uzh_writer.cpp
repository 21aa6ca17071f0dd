#include "evo/io/uzh_writer.hpp"

#include <charconv>
#include <string>

namespace evo::io {

namespace {

void AppendNumber(std::string* text, std::int64_t number, std::size_t digits = 1) {
  char buffer[20];
  const char* const end = std::to_chars(buffer, buffer + sizeof buffer, number).ptr;
  const auto length = static_cast<std::size_t>(end - buffer);
  if (length < digits) text->append(digits - length, '0');
  text->append(buffer, length);
}

}  // namespace

void UzhEventWriter::Append(const events::EventColumns& events) {
  std::string text;
  for (std::size_t i = 0; i < events.size(); ++i) {
    AppendNumber(&text, events.t[i] / kNsPerSecond);
    text += '.';
    AppendNumber(&text, events.t[i] % kNsPerSecond / 1000, 6);
    text += ' ';
    AppendNumber(&text, events.x[i]);
    text += ' ';
    AppendNumber(&text, events.y[i]);
    text += events.polarity[i] > 0 ? " 1\n" : " 0\n";
  }
  file_.stream() << text;
  file_.Check();
}

}  // namespace evo::io
