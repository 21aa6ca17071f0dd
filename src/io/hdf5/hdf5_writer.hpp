#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "evo/core/output_file.hpp"
#include "io/hdf5/hdf5.hpp"

namespace evo::io::hdf5 {

/// An HDF5 file that appears whole on Commit() or not at all. Every failure is an Error of kind kOutput.
class Writer {
 public:
  explicit Writer(const std::filesystem::path& path);

  /// Creates a data set and its groups. With a `chunk` it is byte-shuffled, deflated and may grow in rows.
  Handle CreateDataset(const std::string& name, const std::vector<hsize_t>& shape,
                       const std::vector<hsize_t>& chunk = {}, hid_t type = H5T_NATIVE_DOUBLE) const;

  /// Writes a whole data set of the type of `values`.
  template <typename Value>
  void Write(const std::string& name, const std::vector<hsize_t>& shape, const std::vector<Value>& values) const {
    WriteAll(CreateDataset(name, shape, {}, TypeOf(Value())), TypeOf(Value()), values.data());
  }

  /// Appends `values` to `dataset`, which holds `rows` rows of the shape `row`.
  template <typename Value>
  void Append(const Handle& dataset, hsize_t rows, const std::vector<hsize_t>& row,
              const std::vector<Value>& values) const {
    AppendRows(dataset, rows, row, TypeOf(Value()), values.size(), values.data());
  }

  void Commit();
  /// Throws HDF5's last failure unless `good`.
  void Check(bool good) const;

 private:
  static hid_t TypeOf(double) { return H5T_NATIVE_DOUBLE; }
  static hid_t TypeOf(std::int64_t) { return H5T_NATIVE_INT64; }
  static hid_t TypeOf(std::uint8_t) { return H5T_NATIVE_UINT8; }

  Handle Checked(hid_t id, herr_t (*close)(hid_t)) const;
  void WriteAll(const Handle& dataset, hid_t type, const void* values) const;
  void AppendRows(const Handle& dataset, hsize_t rows, const std::vector<hsize_t>& row, hid_t type, std::size_t count,
                  const void* values) const;

  PendingPath pending_;
  Handle file_;
  Handle link_creation_;
};

}  // namespace evo::io::hdf5
