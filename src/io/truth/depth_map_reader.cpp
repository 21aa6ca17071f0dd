#include "evo/io/depth_map_reader.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "evo/core/error.hpp"
#include "evo/core/number.hpp"
#include "evo/io/file_kind.hpp"
#include "io/hdf5/hdf5.hpp"
#include "io/text_lines.hpp"

namespace evo::io {

namespace {

constexpr char kMaps[] = "davis/left/depth_image_raw";
constexpr char kStamps[] = "davis/left/depth_image_raw_ts";
constexpr char kMoving[] = "davis/left/moving_image_raw";
constexpr char kRectified[] = "davis/left/depth_image_rect";
constexpr double kMaxSeconds = 9e9;  // int64 holds 9.2e9 s in nanoseconds
constexpr hsize_t kMaxSide = 65536;  // px; the event columns hold 16 bits

hdf5::Dataset OpenMaps(const hdf5::File& file, const std::filesystem::path& path) {
  if (!file.Has(kMaps) && file.Has(kRectified)) {
    throw Error(ErrorKind::kInput, path.string() + ": no data set " + kMaps + ", only " + kRectified +
                                       " of the rectified image; give the file that has both");
  }
  return file.Open(kMaps);
}

std::vector<TimeNs> ReadStamps(const hdf5::Dataset& dataset, hsize_t maps) {
  if (dataset.shape() != std::vector<hsize_t>{maps}) {
    throw dataset.Failure(" has not one stamp for each of the " + std::to_string(maps) + " depth maps");
  }
  std::vector<double> seconds(maps);
  dataset.Read(0, maps, seconds.data());
  std::vector<TimeNs> stamps;
  for (const double s : seconds) {
    const std::string row = " row " + std::to_string(stamps.size()) + ": the stamp ";
    if (!(std::abs(s) < kMaxSeconds)) throw dataset.Failure(row + FormatNumber(s) + " is not a time");
    const TimeNs t = FromSeconds(s);
    if (!stamps.empty() && t <= stamps.back()) {
      throw dataset.Failure(row + FormatTime(t) + " s is not later than the one before");
    }
    stamps.push_back(t);
  }
  return stamps;
}

}  // namespace

struct DepthMapReader::State {
  explicit State(const std::filesystem::path& path) : file(path), maps(OpenMaps(file, path)) {
    const auto& shape = maps.shape();
    if (shape.size() != 3) throw maps.Failure(" is not N x height x width");
    if (shape[0] == 0) throw maps.Failure(" holds no depth maps");
    if (shape[1] == 0 || shape[2] == 0 || shape[1] > kMaxSide || shape[2] > kMaxSide) {
      throw maps.Failure(" has images of an impossible size");
    }
    stamps = ReadStamps(file.Open(kStamps), shape[0]);
    if (!file.Has(kMoving)) return;
    moving = file.Open(kMoving);
    if (moving->shape() != shape) throw moving->Failure(std::string(" has not the shape of ") + kMaps);
  }

  hdf5::File file;
  hdf5::Dataset maps;
  std::optional<hdf5::Dataset> moving;
  std::vector<TimeNs> stamps;
};

bool HasDepthMaps(const std::filesystem::path& path) {
  return DetectKind(path) == FileKind::kHdf5 && hdf5::File(path).Has(kMaps);
}

DepthMapReader::DepthMapReader(const std::filesystem::path& path) {
  RequireKind(path, {FileKind::kHdf5}, "an MVSEC _gt.hdf5 with depth maps");
  state_ = std::make_unique<State>(path);
}

DepthMapReader::~DepthMapReader() = default;

const std::vector<TimeNs>& DepthMapReader::stamps() const { return state_->stamps; }
int DepthMapReader::width() const { return static_cast<int>(state_->maps.shape()[2]); }
int DepthMapReader::height() const { return static_cast<int>(state_->maps.shape()[1]); }

events::DepthMap DepthMapReader::Read(std::size_t index) const {
  const std::size_t pixels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
  events::DepthMap map{width(), height(), std::vector<double>(pixels)};
  state_->maps.Read(index, 1, map.depth.data());
  for (const double depth : map.depth) {
    if (depth < 0.0) {
      throw state_->maps.Failure(" row " + std::to_string(index) + ": the depth " + FormatNumber(depth) +
                                 " m is negative; unknown depths are NaN or 0");
    }
  }
  if (state_->moving) {
    std::vector<double> moves(pixels);
    state_->moving->Read(index, 1, moves.data());
    for (const double moving : moves) {
      if (moving != 0.0 && moving != 1.0) {
        throw state_->moving->Failure(" row " + std::to_string(index) + ": " + FormatNumber(moving) +
                                      " is neither 0 (at rest) nor 1 (moves)");
      }
      map.moving.push_back(moving == 1.0 ? 1 : 0);
    }
  }
  return map;
}

}  // namespace evo::io
