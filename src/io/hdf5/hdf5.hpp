#pragma once

#include <hdf5.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "evo/core/error.hpp"

/// The part of HDF5's C library that the readers and writers use. Identifiers close themselves, HDF5 prints nothing and
/// every failure is an Error of kind kInput that names the file and the data set.
namespace evo::io::hdf5 {

/// An HDF5 identifier and the function that closes it.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() { Close(); }
  Handle(Handle&& other) noexcept;
  Handle& operator=(Handle&& other) noexcept;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }
  /// Returns false if HDF5 could not close it; the file then lacks some of the written data.
  bool Close();

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

/// Switches off HDF5's error stack on this thread and its cleanup at exit. Call it before any other use of HDF5.
void SetUp();

/// The reason of the last failure in HDF5's words.
std::string LastFailure();

/// A numeric data set, read as doubles.
class Dataset {
 public:
  const std::vector<hsize_t>& shape() const { return shape_; }
  /// Rows of a chunk; 0 if the data set is not chunked.
  hsize_t chunk_rows() const { return chunk_rows_; }
  bool is_integer() const { return is_integer_; }
  std::size_t element_bytes() const { return element_bytes_; }
  hid_t id() const { return id_.get(); }

  /// Reads rows [first, first + rows), row-major.
  void Read(hsize_t first, hsize_t rows, double* values) const;
  /// Reads element (row, column) of a two-dimensional data set.
  double ReadElement(hsize_t row, hsize_t column) const;
  /// The error "<file>: <data set><what>".
  Error Failure(const std::string& what) const;

 private:
  friend class File;
  Dataset(hid_t file, const std::string& path, std::string name);
  void CheckFilters(hid_t creation) const;
  void ReadBlock(const std::vector<hsize_t>& first, const std::vector<hsize_t>& count, double* values) const;

  std::string path_;
  std::string name_;
  Handle id_;
  std::vector<hsize_t> shape_;
  hsize_t chunk_rows_ = 0;
  bool is_integer_ = false;
  std::size_t element_bytes_ = 0;
};

/// A file opened for reading.
class File {
 public:
  explicit File(const std::filesystem::path& path);

  /// Full names of all data sets, sorted.
  const std::vector<std::string>& datasets() const { return datasets_; }
  bool Has(const std::string& name) const;
  /// Throws if the data set is missing (the message lists the others), not numeric or of a filter that is not
  /// installed.
  Dataset Open(const std::string& name) const;

 private:
  std::string path_;
  Handle id_;
  std::vector<std::string> datasets_;
};

}  // namespace evo::io::hdf5
