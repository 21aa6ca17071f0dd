#include "io/events/mvsec_events.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "evo/core/number.hpp"
#include "io/events/event_errors.hpp"

namespace evo::io {

namespace {

constexpr double kMaxNs = 9e18;          // int64 holds 9.2e18
constexpr double kMaxStampStepS = 1e-3;  // s; coarser stamps lose the motion within a window
constexpr double kMinEpochS = 5e8;       // 1985; a smaller stamp counts from the start of the recording
constexpr double kMaxEpochS = 8e9;       // 2223

/// FromSeconds() without calls to the mathematics library; `seconds` must be in range.
TimeNs SecondsToNs(double seconds) {
  auto whole = static_cast<TimeNs>(seconds);
  whole -= static_cast<double>(whole) > seconds ? 1 : 0;
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): the rest is not negative, and lround is a call for each event
  return whole * kNsPerSecond + static_cast<TimeNs>((seconds - static_cast<double>(whole)) * 1e9 + 0.5);
}

std::string Row(hsize_t row) { return " row " + std::to_string(row) + ": "; }

std::string NotATime(double stamp) { return "the stamp " + FormatNumber(stamp) + " is not a time"; }

bool IsPolarity(double p) { return (p == 1.0) | (p == 0.0) | (p == -1.0); }

// Added to a number below 2^51, it leaves the nearest integer in the lowest bits: a conversion that vectorises.
constexpr double kToInteger = 0x1p52;

/// Returns false if a value is not a whole number in [0, size).
bool ConvertCoordinates(const double* values, std::size_t count, int size, std::uint16_t* __restrict coordinates) {
  const auto last = static_cast<std::uint64_t>(size - 1);
  std::int64_t outside = 0;  // negative if a value is out of range
  std::int64_t broken = 0;   // not zero if a value is not whole
  for (std::size_t i = 0; i < count; ++i) {
    const double shifted = values[i] + kToInteger;
    // Unsigned, since the difference may overflow.
    const std::uint64_t pixel = std::bit_cast<std::uint64_t>(shifted) - std::bit_cast<std::uint64_t>(kToInteger);
    outside |= static_cast<std::int64_t>(pixel | (last - pixel));
    broken |= std::bit_cast<std::int64_t>((shifted - kToInteger) - values[i]);
    coordinates[i] = static_cast<std::uint16_t>(pixel);
  }
  return outside >= 0 && broken == 0;
}

/// Returns false if a value is none of -1, 0 and 1.
bool ConvertPolarities(const double* values, std::size_t count, std::int8_t* __restrict polarities) {
  std::uint64_t broken = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double p = values[i];
    broken |= std::bit_cast<std::uint64_t>(p * (p * p - 1.0)) << 1;  // without the sign of a zero
    const std::uint64_t positive = std::bit_cast<std::uint64_t>(0.0 - p) >> 63;
    polarities[i] = static_cast<std::int8_t>(2 * positive - 1);
  }
  return broken == 0;
}

}  // namespace

MvsecEvents::MvsecEvents(const hdf5::File& file) : events_(file.Open(kMvsecEvents)) {
  CheckShape();
  unit_ = FindUnit();
  CheckResolution();
}

void MvsecEvents::CheckShape() const {
  const auto& shape = table().shape();
  if (shape.size() != 2 || shape[1] != 4) {
    std::string text;
    for (const hsize_t size : shape) text += (text.empty() ? "" : " x ") + std::to_string(size);
    throw table().Failure(" has the shape " + text + "; expected N x 4 with the columns x y t p");
  }
  if (shape[0] == 0) throw table().Failure(" holds no events");
}

MvsecEvents::StampUnit MvsecEvents::FindUnit() const {
  if (!table().is_integer()) return {};
  const double first = table().ReadElement(0, 2);
  for (const TimeNs ns_per_tick : {TimeNs{1}, TimeNs{1000}}) {
    const double seconds = first * static_cast<double>(ns_per_tick) * 1e-9;
    if (seconds >= kMinEpochS && seconds <= kMaxEpochS) return {false, ns_per_tick};
  }
  throw table().Failure(" holds integers, and the unit of its stamps (first: " + FormatNumber(first) +
                        ") cannot be told; store the stamps as float64 seconds");
}

/// A float32 resolves an epoch stamp to two minutes: such a file has lost its times.
void MvsecEvents::CheckResolution() const {
  if (table().is_integer() || table().element_bytes() >= sizeof(double)) return;
  const auto last = static_cast<float>(std::abs(table().ReadElement(rows() - 1, 2)));
  const double step = std::nextafter(last, HUGE_VALF) - last;
  if (std::isfinite(last) && step > kMaxStampStepS) {
    throw table().Failure(" holds float32 numbers, which keep its stamps only to " + FormatNumber(step) +
                          " s; store them as float64");
  }
}

bool MvsecEvents::InRange(double stamp) const {
  return std::abs(stamp) < (unit_.seconds ? kMaxNs * 1e-9 : kMaxNs / static_cast<double>(unit_.ns_per_tick));
}

TimeNs MvsecEvents::ToNs(double stamp) const {
  return unit_.seconds ? SecondsToNs(stamp) : static_cast<TimeNs>(stamp) * unit_.ns_per_tick;
}

TimeNs MvsecEvents::ReadStamp(hsize_t row) const {
  const double stamp = table().ReadElement(row, 2);
  if (!InRange(stamp)) throw table().Failure(Row(row) + NotATime(stamp));
  return ToNs(stamp);
}

hsize_t MvsecEvents::FindRow(TimeNs target) const {
  hsize_t low = 0;
  hsize_t high = rows();
  while (low < high) {
    const hsize_t middle = low + (high - low) / 2;
    if (ReadStamp(middle) < target) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

void MvsecEvents::Read(hsize_t first, std::size_t count, TimeNs previous, int width, int height,
                       events::EventColumns* block) {
  events_.Read(first, count, &values_);
  block->resize(count);
  // The passes have no branches; the faulty event is looked up only if there is one.
  if (ConvertStamps(count, previous, block) && ConvertPixels(count, width, height, block)) return;
  for (std::size_t i = 0; i < count; ++i) {
    const std::array<double, 4> event{values_[i], values_[count + i], values_[2 * count + i], values_[3 * count + i]};
    const std::string fault = Fault(event, previous, width, height);
    if (!fault.empty()) throw table().Failure(Row(first + i) + fault);
    previous = ToNs(event[2]);
  }
}

bool MvsecEvents::ConvertStamps(std::size_t count, TimeNs previous, events::EventColumns* block) const {
  const double* const values = values_.data() + 2 * count;
  bool valid = true;
  for (std::size_t i = 0; i < count; ++i) valid &= InRange(values[i]);
  if (!valid) return false;
  TimeNs* const stamps = block->t.data();
  for (std::size_t i = 0; i < count; ++i) {
    const TimeNs t = ToNs(values[i]);
    valid &= t >= previous;
    stamps[i] = previous = t;
  }
  return valid;
}

bool MvsecEvents::ConvertPixels(std::size_t count, int width, int height, events::EventColumns* block) const {
  const double* const x = values_.data();
  const double* const y = x + count;
  const double* const p = x + 3 * count;
  return ConvertCoordinates(x, count, width, block->x.data()) &&
         ConvertCoordinates(y, count, height, block->y.data()) && ConvertPolarities(p, count, block->polarity.data());
}

/// The fault of one row for a message; empty if there is none. Time comes first, since it orders the table.
std::string MvsecEvents::Fault(const std::array<double, 4>& event, TimeNs previous, int width, int height) const {
  const double x = event[0];
  const double y = event[1];
  if (!InRange(event[2])) return NotATime(event[2]);
  if (ToNs(event[2]) < previous) return TimeBackwardsMessage(previous, ToNs(event[2]));
  if (!std::isfinite(x + y) || x != std::floor(x) || y != std::floor(y)) {
    return "the pixel (" + FormatNumber(x) + ", " + FormatNumber(y) + ") is not whole";
  }
  if (x < 0.0 || x >= width || y < 0.0 || y >= height) return OffSensorMessage(x, y, width, height);
  if (!IsPolarity(event[3])) return "the polarity " + FormatNumber(event[3]) + " is none of -1, 0 and 1";
  return "";
}

}  // namespace evo::io
