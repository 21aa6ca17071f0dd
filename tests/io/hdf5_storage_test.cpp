// Tables stored in ways that evo-run itself never writes must read as they do with HDF5's own H5Dread.

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/hdf5_support.hpp"
#include "io/support.hpp"

namespace evo::io {
namespace {

constexpr hsize_t kColumns = 4;
using Bytes = std::vector<unsigned char>;
using Properties = std::function<void(hid_t creation)>;

/// A table of events to be written piece by piece, in a file of its own that is complete once this is gone.
class EventTable {
 public:
  EventTable(const std::filesystem::path& path, hsize_t rows, const Properties& properties, bool newest_format) {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    if (newest_format) H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    file_ = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    properties(creation);
    const std::vector<hsize_t> shape{rows, kColumns};
    const hid_t space = H5Screate_simple(2, shape.data(), nullptr);
    table_ = H5Dcreate2(file_, "davis/left/events", H5T_IEEE_F64LE, space, links, creation, H5P_DEFAULT);
    EXPECT_GE(table_, 0);
    for (const hid_t list : {access, links, creation}) H5Pclose(list);
    H5Sclose(space);
  }
  ~EventTable() {
    H5Dclose(table_);
    H5Fclose(file_);
  }
  EventTable(const EventTable&) = delete;
  EventTable& operator=(const EventTable&) = delete;

  void Write(const std::vector<double>& rows) const {
    EXPECT_GE(H5Dwrite(table_, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), 0);
  }
  /// `skipped`: bit i tells that the chunk has not been through filter i.
  void WriteChunk(hsize_t row, hsize_t column, unsigned skipped, const Bytes& stored) const {
    const std::vector<hsize_t> offset{row, column};
    EXPECT_GE(H5Dwrite_chunk(table_, H5P_DEFAULT, skipped, offset.data(), stored.size(), stored.data()), 0);
  }

 private:
  hid_t file_;
  hid_t table_;
};

std::vector<double> RowsByHdf5(const std::filesystem::path& path, std::size_t count) {
  std::vector<double> rows(kColumns * count);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t table = H5Dopen2(file, "davis/left/events", H5P_DEFAULT);
  EXPECT_GE(H5Dread(table, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), 0);
  H5Dclose(table);
  H5Fclose(file);
  return rows;
}

events::EventColumns EventsOf(const std::vector<double>& rows) {
  events::EventColumns events;
  for (std::size_t i = 0; i < rows.size(); i += kColumns) {
    events.push_back(FromSeconds(rows[i + 2]), static_cast<std::uint16_t>(rows[i]),
                     static_cast<std::uint16_t>(rows[i + 1]), rows[i + 3] > 0.0 ? std::int8_t{1} : std::int8_t{-1});
  }
  return events;
}

/// The file holds just these rows, whoever reads it and wherever reading begins.
void ExpectRows(const std::filesystem::path& path, const std::vector<double>& rows) {
  EXPECT_TRUE(RowsByHdf5(path, rows.size() / kColumns) == rows);
  const events::EventColumns events = EventsOf(rows);
  ExpectSame(ReadAll(path), events);
  const events::Interval middle{(events.t.back() - events.t[0]) / 3, (events.t.back() - events.t[0]) / 2};
  const events::EventColumns cut = Cut(events, middle);
  if (!cut.empty()) ExpectSame(ReadAll(path, middle), cut);
}

struct ChunkShape {
  hsize_t rows, columns;
};

void SetChunk(hid_t creation, const ChunkShape& chunk) {
  const std::vector<hsize_t> sizes{chunk.rows, chunk.columns};
  H5Pset_chunk(creation, 2, sizes.data());
}

/// The bytes of the chunk that begins at (row, column), without filters; zero beyond the table.
Bytes ChunkOf(const std::vector<double>& rows, const ChunkShape& chunk, hsize_t row, hsize_t column) {
  std::vector<double> values(chunk.rows * chunk.columns, 0.0);
  for (hsize_t r = 0; r < chunk.rows && row + r < rows.size() / kColumns; ++r) {
    for (hsize_t c = 0; c < chunk.columns && column + c < kColumns; ++c) {
      values[r * chunk.columns + c] = rows[(row + r) * kColumns + column + c];
    }
  }
  Bytes bytes(values.size() * sizeof(double));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

Bytes Shuffled(const Bytes& bytes) {
  const std::size_t count = bytes.size() / sizeof(double);
  Bytes shuffled(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) shuffled[i % sizeof(double) * count + i / sizeof(double)] = bytes[i];
  return shuffled;
}

Bytes Deflated(const Bytes& bytes) {
  uLongf size = compressBound(bytes.size());
  Bytes deflated(size);
  EXPECT_EQ(compress(deflated.data(), &size, bytes.data(), bytes.size()), Z_OK);
  deflated.resize(size);
  return deflated;
}

class Hdf5StorageTest : public IoTest {
 protected:
  void Store(const Properties& properties, const std::vector<double>& rows, bool newest_format = false) const {
    EventTable(path, rows.size() / kColumns, properties, newest_format).Write(rows);
  }

  const std::filesystem::path path = folder / "a.hdf5";
};

TEST_F(Hdf5StorageTest, ReadsChecksummedChunks) {
  const std::vector<double> rows = EventRows(MakeEvents(5000, 0));
  using Filter = herr_t (*)(hid_t);
  const Filter checksum = H5Pset_fletcher32;
  const Filter shuffle = H5Pset_shuffle;
  const Filter deflate = [](hid_t creation) { return H5Pset_deflate(creation, 4); };
  for (const std::vector<Filter>& filters : std::vector<std::vector<Filter>>{{checksum},
                                                                             {deflate, checksum},
                                                                             {checksum, deflate},
                                                                             {shuffle, checksum},
                                                                             {shuffle, deflate, checksum},
                                                                             {checksum, shuffle, deflate}}) {
    for (const ChunkShape chunk : {ChunkShape{512, 4}, {512, 1}, {5000, 3}}) {
      const auto properties = [&](hid_t creation) {
        SetChunk(creation, chunk);
        for (const Filter filter : filters) filter(creation);
      };
      Store(properties, rows);
      ExpectRows(path, rows);
    }
  }
}

TEST_F(Hdf5StorageTest, RefusesAChunkWithAWrongChecksum) {
  std::vector<double> rows = EventRows(MakeEvents(2000, 0));
  const auto properties = [](hid_t creation) {
    SetChunk(creation, {512, 4});
    H5Pset_fletcher32(creation);
  };
  Store(properties, rows);
  // Another pixel, as valid as the true one: only the checksum tells.
  const auto bytes_of_row = [&](std::size_t row) {
    return std::string(reinterpret_cast<const char*>(&rows[kColumns * row]), kColumns * sizeof(double));
  };
  std::string bytes = Content(path);
  const auto place = bytes.find(bytes_of_row(700));
  ASSERT_NE(place, std::string::npos);
  rows[kColumns * 700] = rows[kColumns * 700] == 5.0 ? 6.0 : 5.0;
  bytes.replace(place, kColumns * sizeof(double), bytes_of_row(700));
  Write("a.hdf5", bytes);
  ExpectMentions(Refusal([&] { ReadAll(path); }), {"a.hdf5: davis/left/events", "damaged"});
}

TEST_F(Hdf5StorageTest, ReadsChunksThatSkippedFilters) {
  constexpr unsigned kShuffleSkipped = 1, kDeflateSkipped = 2;
  const std::vector<double> rows = EventRows(MakeEvents(3000, 0));
  for (const bool newest_format : {false, true}) {
    for (const ChunkShape chunk : {ChunkShape{256, 4}, {256, 1}, {256, 3}, {3000, 4}}) {
      for (unsigned start = 0; start < 4; ++start) {
        {
          const auto properties = [&](hid_t creation) {
            SetChunk(creation, chunk);
            H5Pset_shuffle(creation);
            H5Pset_deflate(creation, 4);
          };
          const EventTable table(path, rows.size() / kColumns, properties, newest_format);
          unsigned skipped = start;  // each chunk other filters
          for (hsize_t row = 0; row < rows.size() / kColumns; row += chunk.rows) {
            for (hsize_t column = 0; column < kColumns; column += chunk.columns, skipped = (skipped + 1) % 4) {
              Bytes stored = ChunkOf(rows, chunk, row, column);
              if (!(skipped & kShuffleSkipped)) stored = Shuffled(stored);
              if (!(skipped & kDeflateSkipped)) stored = Deflated(stored);
              table.WriteChunk(row, column, skipped, stored);
            }
          }
        }
        ExpectRows(path, rows);
      }
    }
  }
}

TEST_F(Hdf5StorageTest, ReadsEdgeChunksThatAreExemptFromFilters) {
  const std::vector<double> rows = EventRows(MakeEvents(3000, 0));
  for (const bool compress : {false, true}) {
    const auto properties = [&](hid_t creation) {
      SetChunk(creation, {512, 4});
      H5Pset_shuffle(creation);
      if (compress) H5Pset_deflate(creation, 4);
      H5Pset_chunk_opts(creation, H5D_CHUNK_DONT_FILTER_PARTIAL_CHUNKS);
    };
    Store(properties, rows, true);
    ExpectRows(path, rows);
  }
}

TEST_F(Hdf5StorageTest, ReadsTheFillValueOfUnwrittenChunks) {
  for (const double fill : {0.0, 1.0}) {  // both are valid in every column
    const std::vector<double> rows = EventRows(MakeEvents(3000, FromSeconds(fill)));
    for (const bool compress : {false, true}) {
      for (const ChunkShape chunk : {ChunkShape{256, 4}, {256, 1}, {256, 2}}) {
        std::vector<double> expected = rows;
        {
          const auto properties = [&](hid_t creation) {
            SetChunk(creation, chunk);
            H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &fill);
            if (!compress) return;
            H5Pset_shuffle(creation);
            H5Pset_deflate(creation, 4);
          };
          const EventTable table(path, rows.size() / kColumns, properties, false);
          for (hsize_t row = 0; row < rows.size() / kColumns; row += chunk.rows) {
            for (hsize_t column = 0; column < kColumns; column += chunk.columns) {
              // Stamps may be left out only at the start, where they do not run backwards.
              const bool has_stamps = column <= 2 && 2 < column + chunk.columns;
              const bool left_out = row == 0 || (!has_stamps && (row / chunk.rows + column) % 3 == 0);
              if (!left_out) {
                const Bytes plain = ChunkOf(rows, chunk, row, column);
                table.WriteChunk(row, column, 0, compress ? Deflated(Shuffled(plain)) : plain);
                continue;
              }
              for (hsize_t r = row; r < std::min<hsize_t>(row + chunk.rows, rows.size() / kColumns); ++r) {
                for (hsize_t c = column; c < column + chunk.columns; ++c) expected[r * kColumns + c] = fill;
              }
            }
          }
        }
        ExpectRows(path, expected);
      }
    }
  }
}

TEST_F(Hdf5StorageTest, ReadsTheFillValueOfAnUnwrittenTable) {
  const double fill = 1.0;
  const std::vector<double> expected(kColumns * 1000, fill);
  for (const H5D_layout_t layout : {H5D_CHUNKED, H5D_CONTIGUOUS}) {
    const auto properties = [&](hid_t creation) {
      H5Pset_layout(creation, layout);
      if (layout == H5D_CHUNKED) SetChunk(creation, {256, 4});
      H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &fill);
    };
    { const EventTable table(path, expected.size() / kColumns, properties, false); }
    ExpectRows(path, expected);
  }
}

TEST_F(Hdf5StorageTest, ReadsContiguousTables) {
  const std::vector<double> rows = EventRows(MakeEvents(1500, 0));
  for (const H5D_layout_t layout : {H5D_CONTIGUOUS, H5D_COMPACT}) {
    for (const bool newest_format : {false, true}) {
      Store([&](hid_t creation) { H5Pset_layout(creation, layout); }, rows, newest_format);
      ExpectRows(path, rows);
    }
  }
}

}  // namespace
}  // namespace evo::io
