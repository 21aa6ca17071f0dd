#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/hdf5/hdf5.hpp"

namespace evo::io::hdf5 {

/// Reads the columns of an N x M table of numbers as doubles. Chunks of float64, plain or (byte-shuffled and) deflated,
/// are decoded here, straight into the columns: HDF5 would copy each of them several times. All else is left to HDF5.
class ColumnReader {
 public:
  /// Larger chunks are best read in parts of so many rows: HDF5 keeps them decoded meanwhile.
  static constexpr hsize_t kLargestChunkRows = 262144;

  explicit ColumnReader(Dataset table);

  const Dataset& table() const { return table_; }
  /// Rows [first, first + rows): column c fills [c * rows, (c + 1) * rows) of `values`, which grows if it must.
  void Read(hsize_t first, hsize_t rows, std::vector<double>* values);

 private:
  bool IsPlainChunked();
  /// Puts one chunk's share of the rows into `values`; false if HDF5 has to look at it.
  bool ReadChunk(hsize_t chunk_row, hsize_t chunk_column, hsize_t first, hsize_t rows, double* values);
  bool LoadChunk(hsize_t chunk_row, hsize_t chunk_column);
  void ReadWithHdf5(hsize_t first, hsize_t rows, double* values);

  Dataset table_;
  hsize_t chunk_rows_ = 0;
  hsize_t chunk_columns_ = 0;
  bool shuffled_ = false;
  bool deflated_ = false;
  bool direct_ = false;                 ///< whether chunks are decoded here
  std::vector<std::uint8_t> stored_;    ///< a chunk as it lies in the file
  std::vector<std::uint8_t> inflated_;  ///< and without compression
  std::vector<double> elements_;        ///< values row by row
};

}  // namespace evo::io::hdf5
