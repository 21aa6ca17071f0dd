#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_source.hpp"
#include "io/events/event_errors.hpp"
#include "io/events/event_readers.hpp"
#include "io/events/text_event_parser.hpp"
#include "io/text_lines.hpp"

namespace evo::io {

namespace {

constexpr std::size_t kBlockEvents = 65536;
constexpr std::size_t kBlockBytes = 24 * kBlockEvents;   // lines are 18 to 22 bytes long, so blocks come out full
constexpr std::size_t kTypicalLine = 256;                // bytes of the first read at a place
constexpr std::size_t kMaxLine = std::size_t{64} << 10;  // bytes; a longer line is no event and no comment

struct PlacedEvent {
  std::int64_t offset = 0;  ///< byte at which its line starts
  std::int64_t next = 0;    ///< byte at which the next line starts
  TextEvent event;
};

class TextEventReader : public events::EventReader {
 public:
  TextEventReader(const std::filesystem::path& path, const events::Interval& interval, int width, int height)
      : file_(path), width_(width), height_(height) {
    const auto first = EventAtOrAfter(0);
    if (!first) throw Error(ErrorKind::kInput, path.string() + ": holds no events; expected lines 't x y p'");
    first_stamp_ = first->event.t;
    begin_ = interval.from > 0 ? FirstAtOrAfter(SaturatedSum(first_stamp_, interval.from)) : first->offset;
    end_ = interval.to ? FirstAtOrAfter(SaturatedSum(first_stamp_, *interval.to)) : file_.size();
    if (begin_ >= end_) throw EmptyIntervalError(path, interval, first_stamp_, last_stamp());
    offset_ = begin_;
  }

  bool Next(events::EventColumns* block) override {
    while (offset_ < end_) {
      ReadLines();
      ParseLines(block);
      offset_ += static_cast<std::int64_t>(length_);
      if (block->empty()) continue;  // nothing but comments
      previous_ = block->t.back();
      return true;
    }
    block->clear();
    return false;
  }

  TimeNs first_stamp() const override { return first_stamp_; }
  TimeNs last_stamp() const override {
    for (std::int64_t back = kTypicalLine;; back *= 2) {
      TimeNs last = first_stamp_;
      auto found = EventAtOrAfter(std::max<std::int64_t>(file_.size() - back, 0));
      for (; found; found = EventAtOrAfter(found->next)) last = found->event.t;
      if (last != first_stamp_ || back >= file_.size()) return last;
    }
  }
  double progress() const override {
    return static_cast<double>(offset_ - begin_) / static_cast<double>(end_ - begin_);
  }

 private:
  Error Failure(std::int64_t offset, const std::string& what) const {
    return {ErrorKind::kInput, file_.path().string() + ":" + std::to_string(LineNumber(offset)) + ": " + what};
  }

  /// Counted only for an error, since bisection skips lines unseen.
  std::size_t LineNumber(std::int64_t offset) const {
    std::vector<char> buffer(kBlockBytes);
    std::size_t lines = 1;
    for (std::int64_t start = 0; start < offset; start += static_cast<std::int64_t>(kBlockBytes)) {
      const auto count = std::min(kBlockBytes, static_cast<std::size_t>(offset - start));
      const std::size_t got = file_.Read(start, count, buffer.data());
      lines += static_cast<std::size_t>(std::count(buffer.data(), buffer.data() + got, '\n'));
    }
    return lines;
  }

  /// The text from `offset` to the end of the line, without the \n.
  std::string ReadLine(std::int64_t offset) const {
    std::string line;
    for (std::size_t size = kTypicalLine; size <= kMaxLine; size *= kMaxLine / kTypicalLine) {
      line.resize(size);
      line.resize(file_.Read(offset, size, line.data()));
      const std::size_t end = line.find('\n');
      if (end != std::string::npos || line.size() < size) return line.substr(0, end);
    }
    throw Failure(offset, "the line is longer than 64 kB; expected 't x y p'");
  }

  /// The first event whose line starts at or after `position`.
  std::optional<PlacedEvent> EventAtOrAfter(std::int64_t position) const {
    if (position > 0) position += static_cast<std::int64_t>(ReadLine(position - 1).size());
    while (position < file_.size()) {
      const std::string line = ReadLine(position);
      const std::int64_t next = position + static_cast<std::int64_t>(line.size()) + 1;
      std::string fault;
      const auto event = ParseEventLine(line, &fault);
      if (!fault.empty()) throw Failure(position, fault);
      if (event) return PlacedEvent{position, next, *event};
      position = next;
    }
    return std::nullopt;
  }

  /// Offset of the first event at or after `target`, by bisection over the bytes: lines are in order of time.
  std::int64_t FirstAtOrAfter(TimeNs target) const {
    std::int64_t low = 0;
    std::int64_t high = file_.size();
    while (low < high) {
      const std::int64_t middle = low + (high - low) / 2;
      const auto found = EventAtOrAfter(middle);
      if (found && found->event.t < target) {
        low = found->next;
      } else {
        high = middle;
      }
    }
    const auto found = EventAtOrAfter(low);
    return found ? found->offset : file_.size();
  }

  /// Fills buffer_ with whole lines from offset_ on and ends the last one with a \n.
  void ReadLines() {
    const auto wanted = std::min(kBlockBytes, static_cast<std::size_t>(end_ - offset_));
    buffer_.resize(kBlockBytes + 1 + kParserMargin);
    length_ = file_.Read(offset_, wanted, buffer_.data());
    if (length_ < wanted) throw Failure(offset_, "the file became shorter while it was read");
    if (offset_ + static_cast<std::int64_t>(length_) < end_) {
      const std::string_view text(buffer_.data(), length_);
      const std::size_t last = text.rfind('\n');
      if (last == std::string_view::npos) throw Failure(offset_, "the line is longer than 1.5 MB; expected 't x y p'");
      length_ = last + 1;
    }
    buffer_[length_] = '\n';
  }

  void ParseLines(events::EventColumns* block) {
    block->resize(kBlockEvents);
    const char* p = buffer_.data();
    const char* const end = p + length_;
    std::size_t count = 0;
    TimeNs previous = previous_;
    bool valid = true;
    while (p < end && count < kBlockEvents) {
      TextEvent event;
      if (const char* next = ParseCommonLine(p, &event)) {
        p = next;
      } else if (!ParseRareLine(&p, &event)) {
        continue;
      }
      valid &= (event.t >= previous) & (event.x >= 0) & (event.x < width_) & (event.y >= 0) & (event.y < height_);
      previous = event.t;
      block->t[count] = event.t;
      block->x[count] = static_cast<std::uint16_t>(event.x);
      block->y[count] = static_cast<std::uint16_t>(event.y);
      block->polarity[count] = event.polarity;
      ++count;
    }
    block->resize(count);
    length_ = static_cast<std::size_t>(std::min(p, end) - buffer_.data());
    if (!valid) ThrowFirstFault();
  }

  /// Moves `*p` to the next line; false if this one is blank or a comment.
  bool ParseRareLine(const char** p, TextEvent* event) const {
    const char* const start = *p;
    const std::string_view rest(start, static_cast<std::size_t>(buffer_.data() + length_ - start));
    const std::string_view line = rest.substr(0, rest.find('\n'));
    *p = start + line.size() + 1;
    std::string fault;
    const auto parsed = ParseEventLine(line, &fault);
    if (!fault.empty()) throw Failure(offset_ + (start - buffer_.data()), fault);
    if (parsed) *event = *parsed;
    return parsed.has_value();
  }

  /// Throws at the first invalid event of buffer_, whose lines all parse.
  void ThrowFirstFault() const {
    TimeNs previous = previous_;
    const char* const end = buffer_.data() + length_;
    for (const char* p = buffer_.data(); p < end;) {
      const std::int64_t offset = offset_ + (p - buffer_.data());
      TextEvent event;
      if (!ParseRareLine(&p, &event)) continue;
      if (event.t < previous) throw Failure(offset, TimeBackwardsMessage(previous, event.t));
      if (event.x < 0 || event.x >= width_ || event.y < 0 || event.y >= height_) {
        const auto x = static_cast<double>(event.x);
        const auto y = static_cast<double>(event.y);
        throw Failure(offset, OffSensorMessage(x, y, width_, height_));
      }
      previous = event.t;
    }
  }

  ByteSource file_;
  int width_;
  int height_;
  TimeNs first_stamp_ = 0;
  std::int64_t begin_ = 0;
  std::int64_t end_ = 0;
  std::int64_t offset_ = 0;  ///< byte at which the next line starts
  TimeNs previous_ = std::numeric_limits<TimeNs>::min();
  std::vector<char> buffer_;
  std::size_t length_ = 0;  ///< bytes of whole lines in buffer_; after parsing, of those in the block
};

}  // namespace

std::unique_ptr<events::EventReader> OpenTextEvents(const std::filesystem::path& path, const events::Interval& interval,
                                                    int width, int height) {
  return std::make_unique<TextEventReader>(path, interval, width, height);
}

}  // namespace evo::io
