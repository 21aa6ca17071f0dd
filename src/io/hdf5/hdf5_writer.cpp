#include "io/hdf5/hdf5_writer.hpp"

namespace evo::io::hdf5 {

namespace {

constexpr unsigned kDeflateLevel = 4;  // another level would change the bytes of simulated files

}  // namespace

Writer::Writer(const std::filesystem::path& path) : pending_(path) {
  SetUp();
  file_ = Checked(H5Fcreate(pending_.temporary().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  link_creation_ = Handle(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(link_creation_.get(), 1);
}

Handle Writer::CreateDataset(const std::string& name, const std::vector<hsize_t>& shape,
                             const std::vector<hsize_t>& chunk, hid_t type) const {
  std::vector<hsize_t> max_shape = shape;
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.get(), 0);  // the same content gives the same bytes
  if (!chunk.empty()) {
    max_shape[0] = H5S_UNLIMITED;
    H5Pset_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data());
    H5Pset_shuffle(creation.get());
    H5Pset_deflate(creation.get(), kDeflateLevel);
  }
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), max_shape.data()), H5Sclose);
  return Checked(
      H5Dcreate2(file_.get(), name.c_str(), type, space.get(), link_creation_.get(), creation.get(), H5P_DEFAULT),
      H5Dclose);
}

void Writer::WriteAll(const Handle& dataset, hid_t type, const void* values) const {
  Check(H5Dwrite(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
}

void Writer::AppendRows(const Handle& dataset, hsize_t rows, const std::vector<hsize_t>& row, hid_t type,
                        std::size_t count, const void* values) const {
  hsize_t row_values = 1;
  for (const hsize_t size : row) row_values *= size;
  std::vector<hsize_t> block{count / row_values};
  block.insert(block.end(), row.begin(), row.end());
  std::vector<hsize_t> shape = block;
  shape[0] += rows;
  std::vector<hsize_t> offset(block.size(), 0);
  offset[0] = rows;
  Check(H5Dset_extent(dataset.get(), shape.data()) >= 0);
  const Handle memory(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose);
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  Check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, offset.data(), nullptr, block.data(), nullptr) >= 0);
  Check(H5Dwrite(dataset.get(), type, memory.get(), space.get(), H5P_DEFAULT, values) >= 0);
}

void Writer::Commit() {
  Check(file_.Close());
  pending_.Commit();
}

void Writer::Check(bool good) const {
  if (good) return;
  throw Error(ErrorKind::kOutput,
              pending_.path().string() + ": writing failed: " + LastFailure() + "; is the disk full?");
}

Handle Writer::Checked(hid_t id, herr_t (*close)(hid_t)) const {
  Check(id >= 0);
  return {id, close};
}

}  // namespace evo::io::hdf5
