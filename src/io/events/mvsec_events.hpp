#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"
#include "io/hdf5/hdf5.hpp"
#include "io/hdf5/hdf5_columns.hpp"

namespace evo::io {

inline constexpr char kMvsecEvents[] = "davis/left/events";

/// The event table of an MVSEC file, N x 4 of x y t p with N > 0. Errors are of kind kInput and name file and row.
class MvsecEvents {
 public:
  explicit MvsecEvents(const hdf5::File& file);

  hsize_t rows() const { return table().shape()[0]; }
  /// Rows to read at a time, at multiples of it, so that no chunk is decoded twice.
  hsize_t block_rows() const { return events_.block_rows(); }
  TimeNs ReadStamp(hsize_t row) const;
  /// The first row at or after `target`, found by bisection; rows() if there is none.
  hsize_t FindRow(TimeNs target) const;
  /// Reads events [first, first + count) and checks that stamps do not decrease from `previous` on and that pixels are
  /// on the sensor of `width` x `height` px.
  void Read(hsize_t first, std::size_t count, TimeNs previous, int width, int height, events::EventColumns* block);

 private:
  /// The unit of the table's stamps.
  struct StampUnit {
    bool seconds = true;
    TimeNs ns_per_tick = 1;  ///< if not seconds
  };

  const hdf5::Dataset& table() const { return events_.table(); }
  void CheckShape() const;
  StampUnit FindUnit() const;
  void CheckResolution() const;
  bool InRange(double stamp) const;
  TimeNs ToNs(double stamp) const;
  bool ConvertStamps(std::size_t count, TimeNs previous, events::EventColumns* block) const;
  bool ConvertPixels(std::size_t count, int width, int height, events::EventColumns* block) const;
  std::string Fault(const std::array<double, 4>& event, TimeNs previous, int width, int height) const;

  hdf5::ColumnReader events_;
  StampUnit unit_;
  std::vector<double> values_;  ///< the rows read last, column by column
};

}  // namespace evo::io
