#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/hdf5/hdf5.hpp"

namespace evo::io::hdf5 {

/// Reads the columns of an N x M table of numbers as doubles. Chunks of float64, plain or (byte-shuffled and) deflated,
/// are decoded here straight into the columns, since HDF5 copies each of them several times. HDF5 reads all else.
class ColumnReader {
 public:
  explicit ColumnReader(Dataset table);

  const Dataset& table() const { return table_; }
  /// Rows to read at a time, at multiples of it, so that no chunk is decoded twice.
  hsize_t block_rows() const;
  /// Reads rows [first, first + rows): column c fills [c * rows, (c + 1) * rows) of `values`, which grows as needed.
  void Read(hsize_t first, hsize_t rows, std::vector<double>* values);

 private:
  bool IsPlainChunked();
  /// Puts the rows that one chunk holds into `values`; false if HDF5 has to read it.
  bool ReadChunk(hsize_t chunk_row, hsize_t chunk_column, hsize_t first, hsize_t rows, double* values);
  bool LoadChunk(hsize_t chunk_row, hsize_t chunk_column);
  void ReadWithHdf5(hsize_t first, hsize_t rows, double* values);

  Dataset table_;
  hsize_t chunk_rows_ = 0;
  hsize_t chunk_columns_ = 0;
  bool shuffled_ = false;
  bool deflated_ = false;
  bool direct_ = false;                 ///< whether chunks are decoded here
  std::vector<std::uint8_t> stored_;    ///< a chunk as stored in the file
  std::vector<std::uint8_t> inflated_;  ///< the chunk without compression
  std::vector<double> elements_;        ///< values row by row
};

}  // namespace evo::io::hdf5
