#include "evo/events/filtered_event_reader.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "events/flicker/flicker_filter.hpp"
#include "events/hot_pixel_detector.hpp"

namespace evo::events {

namespace {

constexpr std::uint8_t kMasked = 1;
constexpr std::uint8_t kKnownHot = 2;

}  // namespace

struct FilteredEventReader::Changes {
  std::vector<HotPixelDetector::Change> list;
  std::size_t next = 0;  // the first one that is not applied

  TimeNs NextStamp() const { return next < list.size() ? list[next].from : std::numeric_limits<TimeNs>::max(); }
  void ForgetApplied() {
    list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(next));
    next = 0;
  }
};

void Register(Parameters& parameters, EventFilterOptions& options) {
  Register(parameters, options.hot_pixels);
  Register(parameters, options.flicker);
  Register(parameters, options.auto_mask);
}

FilteredEventReader::FilteredEventReader(std::unique_ptr<EventReader> reader, int width, int height,
                                         const EventFilterOptions& options, const IgnoredPixels& ignored)
    : reader_(std::move(reader)),
      width_(static_cast<std::size_t>(width)),
      changes_(std::make_unique<Changes>()),
      prefetcher_(reader_.get()) {
  const std::size_t pixels = width_ * static_cast<std::size_t>(height);
  if (!ignored.masked.empty() && ignored.masked.size() != pixels) {
    throw std::invalid_argument("the mask is not of the sensor's size");
  }
  is_hot_.assign(pixels, 0);
  hot_place_.assign(pixels, 0);
  if (!ignored.masked.empty() || !ignored.hot.empty()) ignored_.assign(pixels, 0);
  for (const std::uint32_t pixel : ignored.hot) {
    ignored_.at(pixel) = kKnownHot;
    CountHot(pixel, 0, 0);
  }
  for (std::size_t i = 0; i < ignored.masked.size(); ++i) {
    if (ignored.masked[i] == 0) continue;
    ignored_[i] = kMasked;
    ++statistics_.masked_pixels;
  }
  if (options.flicker.remove) flicker_ = std::make_unique<FlickerFilter>(width, height, options.flicker);
  if (options.hot_pixels.detect) detector_ = std::make_unique<HotPixelDetector>(width, height, options.hot_pixels);
}

FilteredEventReader::~FilteredEventReader() = default;

bool FilteredEventReader::Next(EventColumns* block) {
  do {
    ReadAhead();
    if (held_.empty()) {
      block->clear();
      return false;
    }
    std::swap(*block, held_.front());
    spare_.push_back(std::move(held_.front()));
    held_.pop_front();
    held_events_ -= block->size();
    ApplyHotPixels(block);
  } while (block->empty());
  return true;
}

void FilteredEventReader::ReadAhead() {
  const auto is_known = [&] {
    return !held_.empty() && (!detector_ || held_.front().t.back() < detector_->known_until());
  };
  while (!has_ended_ && !is_known() && held_events_ < kMaxHeldEvents) {
    EventColumns block;
    if (!spare_.empty()) {
      block = std::move(spare_.back());
      spare_.pop_back();
    }
    has_ended_ = !NextExamined(&block);
    // What the earlier stages have removed does not disturb the quiet of any pixel.
    if (detector_) detector_->Add(block, &changes_->list);
    if (has_ended_ && detector_) detector_->Finish(&changes_->list);
    if (block.empty()) {
      spare_.push_back(std::move(block));
      continue;
    }
    held_events_ += block.size();
    held_.push_back(std::move(block));
  }
}

TimeNs FilteredEventReader::last_stamp() const {
  prefetcher_.Wait();  // the recording is read by one thread at a time
  return reader_->last_stamp();
}

bool FilteredEventReader::NextExamined(EventColumns* block) {
  if (!prefetcher_.Next(block)) {
    block->clear();
    if (flicker_) flicker_->Finish(block);
    return false;
  }
  statistics_.events += block->size();
  ApplyMask(block);
  if (flicker_) flicker_->Apply(block);
  return true;
}

FilterStatistics FilteredEventReader::statistics() const {
  FilterStatistics statistics = statistics_;
  if (flicker_) statistics.flicker = flicker_->statistics();
  return statistics;
}

template <typename Rule>
std::size_t FilteredEventReader::Compact(EventColumns* block, std::size_t begin, std::size_t end, std::size_t kept,
                                         Rule leaves_out) const {
  const std::uint16_t* const x = block->x.data();
  const std::uint16_t* const y = block->y.data();
  // Most events stay: whole stretches of them move at once.
  const auto keep = [&](std::size_t from, std::size_t to) {
    const auto move = [&](auto& column) {
      std::copy(column.begin() + static_cast<std::ptrdiff_t>(from), column.begin() + static_cast<std::ptrdiff_t>(to),
                column.begin() + static_cast<std::ptrdiff_t>(kept));
    };
    if (from != kept) {
      move(block->t);
      move(block->x);
      move(block->y);
      move(block->polarity);
    }
    kept += to - from;
  };
  std::size_t first = begin;  // of the stretch
  for (std::size_t i = begin; i < end; ++i) {
    if (!leaves_out(y[i] * width_ + x[i], i)) [[likely]]
      continue;
    keep(first, i);
    first = i + 1;
  }
  keep(first, end);
  return kept;
}

void FilteredEventReader::ApplyMask(EventColumns* block) {
  if (ignored_.empty()) return;
  const std::size_t kept = Compact(block, 0, block->size(), 0, [&](std::size_t pixel, std::size_t i) {
    const std::uint8_t reason = ignored_[pixel];
    if (reason == kMasked) ++statistics_.masked_events;
    if (reason == kKnownHot) CountHot(pixel, block->t[i], 1);
    return reason != 0;
  });
  block->resize(kept);
}

void FilteredEventReader::ApplyHotPixels(EventColumns* block) {
  std::size_t kept = 0;
  std::size_t begin = 0;
  while (begin < block->size()) {
    for (; changes_->NextStamp() <= block->t[begin]; ++changes_->next) {
      const auto& change = changes_->list[changes_->next];
      is_hot_[change.pixel] = change.is_hot ? 1 : 0;
      hot_pixels_ += change.is_hot ? 1 : std::size_t(-1);
    }
    const auto first = block->t.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto end =
        static_cast<std::size_t>(std::lower_bound(first, block->t.end(), changes_->NextStamp()) - block->t.begin());
    if (hot_pixels_ == 0 && kept == begin) {
      kept = end;
    } else {
      kept = Compact(block, begin, end, kept, [&](std::size_t pixel, std::size_t i) {
        if (is_hot_[pixel] == 0) return false;
        CountHot(pixel, block->t[i], 1);
        return true;
      });
    }
    begin = end;
  }
  block->resize(kept);
  changes_->ForgetApplied();
}

void FilteredEventReader::CountHot(std::size_t pixel, TimeNs t, std::uint64_t events) {
  std::uint32_t& place = hot_place_[pixel];
  if (place == 0) {
    hot_.push_back({static_cast<std::uint16_t>(pixel % width_), static_cast<std::uint16_t>(pixel / width_), t, t, 0});
    place = static_cast<std::uint32_t>(hot_.size());
  }
  HotPixel& found = hot_[place - 1];
  if (found.events == 0) found.first = t;
  found.last = t;
  found.events += events;
  statistics_.hot_events += events;
}

}  // namespace evo::events
