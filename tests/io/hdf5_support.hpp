#pragma once

#include <hdf5.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "evo/events/event_columns.hpp"

namespace evo::io {

/// How a test stores a table: HDF5's own types and layouts, written with its C library and none of our code.
struct Storage {
  hid_t type = H5T_NATIVE_DOUBLE;
  std::vector<hsize_t> chunk;  ///< contiguous if empty
  bool compress = false;
};

inline void StoreTable(const std::filesystem::path& path, const std::string& name, const std::vector<hsize_t>& shape,
                       const std::vector<double>& values, const Storage& storage = {}) {
  const bool exists = std::filesystem::exists(path);
  const hid_t file = exists ? H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)
                            : H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  if (!storage.chunk.empty()) H5Pset_chunk(creation, static_cast<int>(storage.chunk.size()), storage.chunk.data());
  if (storage.compress) {
    H5Pset_shuffle(creation);
    H5Pset_deflate(creation, 4);
  }
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t dataset = H5Dcreate2(file, name.c_str(), storage.type, space, links, creation, H5P_DEFAULT);
  if (!values.empty()) H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(dataset);
  H5Sclose(space);
  H5Pclose(creation);
  H5Pclose(links);
  H5Fclose(file);
}

/// Rows x y t p with the stamps in units of `ns_per_tick`.
inline std::vector<double> EventRows(const events::EventColumns& events, TimeNs ns_per_tick = kNsPerSecond) {
  std::vector<double> rows;
  for (std::size_t i = 0; i < events.size(); ++i) {
    rows.push_back(events.x[i]);
    rows.push_back(events.y[i]);
    rows.push_back(static_cast<double>(events.t[i] / ns_per_tick) +
                   static_cast<double>(events.t[i] % ns_per_tick) / static_cast<double>(ns_per_tick));
    rows.push_back(events.polarity[i]);
  }
  return rows;
}

inline void StoreEvents(const std::filesystem::path& path, const std::vector<double>& rows,
                        const Storage& storage = {}) {
  StoreTable(path, "davis/left/events", {rows.size() / 4, 4}, rows, storage);
}

}  // namespace evo::io
