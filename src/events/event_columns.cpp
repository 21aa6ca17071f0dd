#include "evo/events/event_columns.hpp"

namespace evo::events {

void EventColumns::clear() {
  t.clear();
  x.clear();
  y.clear();
  polarity.clear();
}

void EventColumns::reserve(std::size_t count) {
  t.reserve(count);
  x.reserve(count);
  y.reserve(count);
  polarity.reserve(count);
}

void EventColumns::resize(std::size_t count) {
  t.resize(count);
  x.resize(count);
  y.resize(count);
  polarity.resize(count);
}

void EventColumns::push_back(TimeNs time, std::uint16_t column, std::uint16_t row, std::int8_t sign) {
  t.push_back(time);
  x.push_back(column);
  y.push_back(row);
  polarity.push_back(sign);
}

}  // namespace evo::events
