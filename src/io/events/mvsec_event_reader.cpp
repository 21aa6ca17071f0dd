#include <algorithm>
#include <limits>

#include "io/events/event_errors.hpp"
#include "io/events/event_readers.hpp"
#include "io/events/mvsec_events.hpp"
#include "io/hdf5/hdf5.hpp"

namespace evo::io {

namespace {

class MvsecEventReader : public events::EventReader {
 public:
  MvsecEventReader(const std::filesystem::path& path, const events::Interval& interval, int width, int height)
      : file_(path), events_(file_), width_(width), height_(height), first_stamp_(events_.ReadStamp(0)) {
    begin_ = interval.from > 0 ? events_.FindRow(SaturatedSum(first_stamp_, interval.from)) : 0;
    end_ = interval.to ? events_.FindRow(SaturatedSum(first_stamp_, *interval.to)) : events_.rows();
    if (begin_ >= end_) throw EmptyIntervalError(path, interval, first_stamp_, last_stamp());
    row_ = begin_;
  }

  bool Next(events::EventColumns* block) override {
    if (row_ == end_) {
      block->clear();
      return false;
    }
    const hsize_t step = events_.block_rows();
    const hsize_t block_end = std::min((row_ / step + 1) * step, end_);
    events_.Read(row_, block_end - row_, previous_, width_, height_, block);
    previous_ = block->t.back();
    row_ = block_end;
    return true;
  }

  TimeNs first_stamp() const override { return first_stamp_; }
  TimeNs last_stamp() const override { return events_.ReadStamp(events_.rows() - 1); }
  double progress() const override { return static_cast<double>(row_ - begin_) / static_cast<double>(end_ - begin_); }

 private:
  hdf5::File file_;
  MvsecEvents events_;
  int width_;
  int height_;
  TimeNs first_stamp_;
  hsize_t begin_ = 0;
  hsize_t end_ = 0;
  hsize_t row_ = 0;  ///< next row to read
  TimeNs previous_ = std::numeric_limits<TimeNs>::min();
};

}  // namespace

std::unique_ptr<events::EventReader> OpenMvsecEvents(const std::filesystem::path& path,
                                                     const events::Interval& interval, int width, int height) {
  return std::make_unique<MvsecEventReader>(path, interval, width, height);
}

}  // namespace evo::io
