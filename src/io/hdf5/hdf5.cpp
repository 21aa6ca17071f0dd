#include "io/hdf5/hdf5.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "io/hdf5/lzf_filter.hpp"

namespace evo::io::hdf5 {

namespace {

constexpr hid_t kDefault = H5P_DEFAULT;
constexpr std::size_t kMaxListedNames = 8;
constexpr std::size_t kCacheSlots = 521;  // HDF5's own default

herr_t CollectDataset(hid_t group, const char* name, const H5L_info_t*, void* names) {
  const Handle object(H5Oopen(group, name, kDefault), H5Oclose);
  if (object.valid() && H5Iget_type(object.get()) == H5I_DATASET) {
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  }
  return 0;  // a dangling link is no reason to give up on the rest
}

}  // namespace

Handle::Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}

Handle& Handle::operator=(Handle&& other) noexcept {
  if (this != &other) {
    Close();
    id_ = std::exchange(other.id_, -1);
    close_ = other.close_;
  }
  return *this;
}

bool Handle::Close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

void SetUp() {
  // Handles close all. HDF5 1.10 crashes at exit if a full disk kept it from closing a file.
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

std::string LastFailure() {
  std::string reason;
  const auto innermost = [](unsigned depth, const H5E_error2_t* entry, void* text) -> herr_t {
    if (depth == 0 && entry->desc) *static_cast<std::string*>(text) = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, innermost, &reason);
  if (reason.empty()) return "unknown HDF5 failure";
  // Only the message of the system, without pointers and the like.
  constexpr std::string_view kSystem = "error message = '";
  const auto found = reason.find(kSystem);
  if (found == std::string::npos) return reason;
  const auto begin = found + kSystem.size();
  return reason.substr(begin, reason.find('\'', begin) - begin);
}

File::File(const std::filesystem::path& path) : path_(path.string()) {
  SetUp();
  RegisterLzf();
  id_ = Handle(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, kDefault), H5Fclose);
  if (!id_.valid()) {
    throw Error(ErrorKind::kInput,
                path_ + ": cannot be opened as HDF5: " + LastFailure() + "; if it was cut short, fetch it again");
  }
  if (H5Lvisit(id_.get(), H5_INDEX_NAME, H5_ITER_INC, CollectDataset, &datasets_) < 0) {
    throw Error(ErrorKind::kInput, path_ + ": damaged HDF5 file: " + LastFailure() + "; fetch it again");
  }
}

bool File::Has(const std::string& name) const { return std::ranges::find(datasets_, name) != datasets_.end(); }

Dataset File::Open(const std::string& name) const {
  if (!Has(name)) {
    std::string listed;
    for (std::size_t i = 0; i < std::min(datasets_.size(), kMaxListedNames); ++i) {
      listed += (i ? ", " : "") + datasets_[i];
    }
    if (datasets_.size() > kMaxListedNames) listed += ", ...";
    throw Error(ErrorKind::kInput, path_ + ": no data set " + name + "; the file holds " +
                                       (listed.empty() ? "no data sets" : listed) +
                                       "; give the MVSEC file that has it");
  }
  return {id_.get(), path_, name};
}

Dataset::Dataset(hid_t file, const std::string& path, std::string name) : path_(path), name_(std::move(name)) {
  id_ = Handle(H5Dopen2(file, name_.c_str(), kDefault), H5Dclose);
  if (!id_.valid()) throw Failure(": damaged: " + LastFailure() + "; fetch the file again");
  const Handle space(H5Dget_space(id_.get()), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 1) throw Failure(": a single value where rows were expected");
  shape_.resize(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.get(), shape_.data(), nullptr);
  const Handle type(H5Dget_type(id_.get()), H5Tclose);
  const H5T_class_t type_class = H5Tget_class(type.get());
  if (type_class != H5T_INTEGER && type_class != H5T_FLOAT) throw Failure(": its elements are not plain numbers");
  is_integer_ = type_class == H5T_INTEGER;
  element_bytes_ = H5Tget_size(type.get());

  const Handle creation(H5Dget_create_plist(id_.get()), H5Pclose);
  CheckFilters(creation.get());
  if (H5Pget_layout(creation.get()) != H5D_CHUNKED) return;
  std::vector<hsize_t> chunk(shape_.size());
  H5Pget_chunk(creation.get(), rank, chunk.data());
  chunk_rows_ = chunk[0];
  // Caches one row of chunks: with HDF5's 1 MB, every read of a part of a large chunk inflates all of it again.
  std::size_t bytes = element_bytes_ * chunk[0];
  for (std::size_t i = 1; i < chunk.size(); ++i) bytes *= (shape_[i] + chunk[i] - 1) / chunk[i] * chunk[i];
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access.get(), kCacheSlots, bytes, H5D_CHUNK_CACHE_W0_DEFAULT);
  id_.Close();  // the cache is sized when a data set is first opened
  id_ = Handle(H5Dopen2(file, name_.c_str(), access.get()), H5Dclose);
  if (!id_.valid()) throw Failure(": damaged: " + LastFailure() + "; fetch the file again");
}

void Dataset::CheckFilters(hid_t creation) const {
  const int filters = H5Pget_nfilters(creation);
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    unsigned config = 0;
    std::size_t parameters = 0;
    char label[64] = "";
    const H5Z_filter_t filter =
        H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &parameters, nullptr, sizeof label, label, &config);
    if (H5Zfilter_avail(filter) > 0) continue;
    const std::string name = *label ? " (" + std::string(label) + ")" : "";
    throw Failure(": compressed with the HDF5 filter " + std::to_string(filter) + name +
                  ", which is not installed; install its HDF5 plugin and name the folder in HDF5_PLUGIN_PATH");
  }
}

void Dataset::Read(hsize_t first, hsize_t rows, double* values) const {
  std::vector<hsize_t> offset(shape_.size(), 0);
  std::vector<hsize_t> count = shape_;
  offset[0] = first;
  count[0] = rows;
  ReadBlock(offset, count, values);
}

double Dataset::ReadElement(hsize_t row, hsize_t column) const {
  double value = 0.0;
  ReadBlock({row, column}, {1, 1}, &value);
  return value;
}

void Dataset::ReadBlock(const std::vector<hsize_t>& first, const std::vector<hsize_t>& count, double* values) const {
  SetUp();
  const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose);
  const Handle space(H5Dget_space(id_.get()), H5Sclose);
  if (H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr) < 0 ||
      H5Dread(id_.get(), H5T_NATIVE_DOUBLE, memory.get(), space.get(), kDefault, values) < 0) {
    throw Failure(": rows " + std::to_string(first[0]) + " to " + std::to_string(first[0] + count[0] - 1) +
                  " cannot be read: " + LastFailure() + "; the file is damaged, fetch it again");
  }
}

Error Dataset::Failure(const std::string& what) const { return {ErrorKind::kInput, path_ + ": " + name_ + what}; }

}  // namespace evo::io::hdf5
