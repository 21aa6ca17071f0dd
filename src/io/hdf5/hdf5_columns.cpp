#include "io/hdf5/hdf5_columns.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "io/hdf5/inflate.hpp"

namespace evo::io::hdf5 {

namespace {

constexpr std::size_t kBytes = sizeof(double);
constexpr hsize_t kMinBlockRows = 65536;      // 2 MB of events: enough work for each read
constexpr hsize_t kMaxChunkRows = 262144;     // HDF5 caches a larger chunk, which is then read in parts of this size
constexpr hsize_t kMaxStoredOverhead = 1024;  // bytes by which incompressible data grows

/// Restores elements [first, first + count) of `total` from byte planes: all first bytes, all second bytes...
void Unshuffle(const std::uint8_t* planes, std::size_t total, std::size_t first, std::size_t count, double* values) {
  const std::uint8_t* const p = planes + first;
  auto* __restrict const bytes = reinterpret_cast<std::uint8_t*>(values);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t b = 0; b < kBytes; ++b) bytes[kBytes * i + b] = p[b * total + i];
  }
}

}  // namespace

ColumnReader::ColumnReader(Dataset table) : table_(std::move(table)), direct_(IsPlainChunked()) {}

bool ColumnReader::IsPlainChunked() {
  const Handle type(H5Dget_type(table_.id()), H5Tclose);
  const Handle creation(H5Dget_create_plist(table_.id()), H5Pclose);
  if (std::endian::native != std::endian::little || table_.shape().size() != 2 ||
      H5Tequal(type.get(), H5T_IEEE_F64LE) <= 0 || H5Pget_layout(creation.get()) != H5D_CHUNKED) {
    return false;
  }
  std::array<hsize_t, 2> chunk{};
  H5Pget_chunk(creation.get(), 2, chunk.data());
  chunk_rows_ = chunk[0];
  chunk_columns_ = chunk[1];
  const int filters = H5Pget_nfilters(creation.get());
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t parameters = 1;
    unsigned parameter = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(creation.get(), static_cast<unsigned>(i), &flags, &parameters, &parameter, 0, nullptr, nullptr);
    const bool known = (filter == H5Z_FILTER_SHUFFLE && i == 0 && parameter == kBytes) ||
                       (filter == H5Z_FILTER_DEFLATE && i + 1 == filters);
    if (!known) return false;
    (filter == H5Z_FILTER_SHUFFLE ? shuffled_ : deflated_) = true;
  }
  unsigned options = 0;  // edge chunks may be exempt from filters
  if (H5Pget_chunk_opts(creation.get(), &options) < 0 || options != 0) return false;
  return chunk_rows_ > 0 && chunk_columns_ > 0 && chunk_rows_ <= kMaxChunkRows && chunk_columns_ <= table_.shape()[1];
}

hsize_t ColumnReader::block_rows() const {
  const hsize_t chunk = std::max<hsize_t>(table_.chunk_rows(), 1);
  return chunk > kMaxChunkRows ? kMaxChunkRows : (kMinBlockRows + chunk - 1) / chunk * chunk;
}

void ColumnReader::Read(hsize_t first, hsize_t rows, std::vector<double>* values) {
  const hsize_t columns = table_.shape()[1];
  values->resize(std::max<std::size_t>(values->size(), rows * columns));
  bool complete = direct_;
  for (hsize_t row = complete ? first / chunk_rows_ : 0; complete && row * chunk_rows_ < first + rows; ++row) {
    for (hsize_t column = 0; complete && column * chunk_columns_ < columns; ++column) {
      complete = ReadChunk(row, column, first, rows, values->data());
    }
  }
  if (!complete) ReadWithHdf5(first, rows, values->data());
}

bool ColumnReader::ReadChunk(hsize_t chunk_row, hsize_t chunk_column, hsize_t first, hsize_t rows, double* values) {
  if (!LoadChunk(chunk_row, chunk_column)) return false;
  const hsize_t start = chunk_row * chunk_rows_;
  const hsize_t begin = std::max(first, start);
  const hsize_t count = std::min(first + rows, start + chunk_rows_) - begin;
  const hsize_t skipped = (begin - start) * chunk_columns_;
  double* const target = values + chunk_column * chunk_columns_ * rows + (begin - first);
  const bool narrow = chunk_columns_ == 1;
  if (!narrow) elements_.resize(count * chunk_columns_);
  double* const elements = narrow ? target : elements_.data();
  if (shuffled_) {
    Unshuffle(inflated_.data(), chunk_rows_ * chunk_columns_, skipped, count * chunk_columns_, elements);
  } else {
    std::memcpy(elements, inflated_.data() + skipped * kBytes, count * chunk_columns_ * kBytes);
  }
  if (narrow) return true;
  const hsize_t columns = std::min(chunk_columns_, table_.shape()[1] - chunk_column * chunk_columns_);
  for (hsize_t c = 0; c < columns; ++c) {
    for (hsize_t i = 0; i < count; ++i) target[c * rows + i] = elements[i * chunk_columns_ + c];
  }
  return true;
}

bool ColumnReader::LoadChunk(hsize_t chunk_row, hsize_t chunk_column) {
  SetUp();  // the error stack is per thread
  const std::array<hsize_t, 2> offset{chunk_row * chunk_rows_, chunk_column * chunk_columns_};
  hsize_t stored_bytes = 0;
  std::uint32_t skipped_filters = 0;
  if (H5Dget_chunk_storage_size(table_.id(), offset.data(), &stored_bytes) < 0 || stored_bytes == 0) return false;
  const hsize_t chunk_bytes = chunk_rows_ * chunk_columns_ * kBytes;
  if (stored_bytes > 2 * chunk_bytes + kMaxStoredOverhead) return false;  // damaged: HDF5 says how
  stored_.resize(stored_bytes);
  if (H5Dread_chunk(table_.id(), H5P_DEFAULT, offset.data(), &skipped_filters, stored_.data()) < 0) return false;
  if (skipped_filters != 0) return false;
  inflated_.resize(chunk_bytes);
  if (deflated_) return Inflate(stored_, inflated_);
  std::swap(stored_, inflated_);
  return inflated_.size() == chunk_bytes;
}

void ColumnReader::ReadWithHdf5(hsize_t first, hsize_t rows, double* values) {
  const hsize_t columns = table_.shape()[1];
  elements_.resize(rows * columns);
  table_.Read(first, rows, elements_.data());
  for (hsize_t c = 0; c < columns; ++c) {
    for (hsize_t i = 0; i < rows; ++i) values[c * rows + i] = elements_[i * columns + c];
  }
}

}  // namespace evo::io::hdf5
