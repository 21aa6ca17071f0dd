#include "evo/io/file_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "evo/core/error.hpp"
#include "evo/core/number.hpp"
#include "evo/io/calibration_io.hpp"
#include "evo/io/depth_map_reader.hpp"
#include "evo/io/file_kind.hpp"
#include "evo/io/open_events.hpp"
#include "evo/io/sequence.hpp"
#include "evo/io/track_io.hpp"
#include "evo/io/trajectory_io.hpp"
#include "io/events/mvsec_events.hpp"
#include "io/hdf5/hdf5.hpp"
#include "io/text_lines.hpp"

namespace evo::io {

namespace {

constexpr int kAnySensor = 65536;  // px; the event columns hold 16 bits
// 65,536 events in 16 places show the whole sensor and take milliseconds to read.
constexpr hsize_t kSamples = 16;
constexpr hsize_t kSampleRows = 4096;

std::string Fixed(double value, int decimals, const std::string& unit) {
  return fmt::format("{:.{}f}{}{}", value, decimals, unit.empty() ? "" : " ", unit);
}

void AddSpan(FileDescription* description, const std::string& prefix, std::size_t count, TimeNs first, TimeNs last,
             const std::string& rate_unit) {
  auto& values = description->values;
  values.emplace_back(prefix + "first stamp", FormatTime(first) + " s");
  values.emplace_back(prefix + "last stamp", FormatTime(last) + " s");
  values.emplace_back(prefix + "duration", FormatTime(last - first) + " s");
  const double seconds = ToSeconds(last - first);
  if (seconds > 0.0)
    values.emplace_back(prefix + "mean rate", Fixed(static_cast<double>(count - 1) / seconds, 1, rate_unit));
}

/// The pixels and the share of positive polarities of some events, those outside `mask` if there is one.
struct EventExtent {
  const Mask* mask = nullptr;
  int left = std::numeric_limits<int>::max();
  int top = std::numeric_limits<int>::max();
  int right = -1;
  int bottom = -1;
  std::size_t events = 0;
  std::size_t positive = 0;
  std::size_t masked = 0;

  void Add(const events::EventColumns& block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (IsMasked(block.x[i], block.y[i])) {
        ++masked;
        continue;
      }
      ++events;
      left = std::min<int>(left, block.x[i]);
      right = std::max<int>(right, block.x[i]);
      top = std::min<int>(top, block.y[i]);
      bottom = std::max<int>(bottom, block.y[i]);
      positive += block.polarity[i] > 0 ? 1 : 0;
    }
  }

  std::size_t all() const { return events + masked; }

  bool IsMasked(int x, int y) const {
    if (!mask || x >= mask->width || y >= mask->height) return false;
    return mask->ignored[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask->width) +
                         static_cast<std::size_t>(x)] != 0;
  }

  void AddTo(FileDescription* description, const std::string& note) const {
    if (mask) {
      const double percent = 100.0 * static_cast<double>(masked) / static_cast<double>(masked + events);
      description->values.emplace_back("masked", Fixed(percent, 1, "% of the events") + note);
    }
    if (events == 0) return;
    const auto range = [&](int low, int high) { return std::to_string(low) + " to " + std::to_string(high) + " px"; };
    description->values.emplace_back("columns", range(left, right) + note);
    description->values.emplace_back("rows", range(top, bottom) + note);
    const double percent = 100.0 * static_cast<double>(positive) / static_cast<double>(events);
    description->values.emplace_back("positive", Fixed(percent, 1, "%") + note);
  }
};

FileDescription DescribeEventText(const std::filesystem::path& path, const Mask* mask) {
  const auto reader = OpenEvents(path, {}, kAnySensor, kAnySensor);
  EventExtent extent{.mask = mask};
  events::EventColumns block;
  TimeNs last = reader->first_stamp();
  while (reader->Next(&block)) {
    extent.Add(block);
    last = block.t.back();
  }
  FileDescription description{"UZH events", {{"events", std::to_string(extent.all())}}};
  AddSpan(&description, "", extent.all(), reader->first_stamp(), last, "events/s");
  extent.AddTo(&description, "");
  return description;
}

void AddMvsecEvents(FileDescription* description, const hdf5::File& file, const Mask* mask) {
  MvsecEvents events(file);
  const hsize_t rows = events.rows();
  description->values.emplace_back("events", std::to_string(rows));
  AddSpan(description, "", rows, events.ReadStamp(0), events.ReadStamp(rows - 1), "events/s");
  EventExtent extent{.mask = mask};
  events::EventColumns block;
  const hsize_t count = std::min(kSampleRows, rows);
  for (hsize_t i = 0; i < kSamples; ++i) {
    const hsize_t first = (rows - count) * i / (kSamples - 1);
    events.Read(first, count, std::numeric_limits<TimeNs>::min(), kAnySensor, kAnySensor, &block);
    extent.Add(block);
  }
  extent.AddTo(description, " (from samples)");
}

void AddPoses(FileDescription* description, const std::string& prefix, const geometry::Trajectory& trajectory) {
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length += (trajectory[i].T_world_cam.translation() - trajectory[i - 1].T_world_cam.translation()).norm();
  }
  description->values.emplace_back(prefix + "poses", std::to_string(trajectory.size()));
  description->values.emplace_back(prefix + "path length", Fixed(length, 3, "m"));
}

void AddTrajectory(FileDescription* description, const std::string& prefix, const geometry::Trajectory& trajectory) {
  AddPoses(description, prefix, trajectory);
  AddSpan(description, prefix, trajectory.size(), trajectory.front().t, trajectory.back().t, "poses/s");
}

FileDescription DescribeHdf5(const std::filesystem::path& path, const Mask* mask) {
  const hdf5::File file(path);
  FileDescription description;
  if (file.Has(kMvsecEvents)) {
    description.kind = "MVSEC events";
    AddMvsecEvents(&description, file, mask);
    return description;
  }
  description.kind = "MVSEC ground truth";
  if (file.Has("davis/left/odometry")) {
    AddTrajectory(&description, "odometry (loam) ", ReadGroundTruth(path, GroundTruthSource::kLoam));
  }
  if (file.Has("davis/left/pose")) {
    AddTrajectory(&description, "pose (cartographer) ", ReadGroundTruth(path, GroundTruthSource::kCartographer));
  }
  if (HasDepthMaps(path)) {
    const DepthMapReader maps(path);
    const std::string size = std::to_string(maps.width()) + " x " + std::to_string(maps.height()) + " px";
    description.values.emplace_back("depth maps", std::to_string(maps.stamps().size()) + " of " + size);
    AddSpan(&description, "depth maps ", maps.stamps().size(), maps.stamps().front(), maps.stamps().back(), "maps/s");
  }
  if (description.values.empty()) file.Open(kMvsecEvents);  // the error lists what the file holds
  return description;
}

FileDescription DescribeTracks(const std::filesystem::path& path) {
  const events::Tracks tracks = ReadTracks(path);
  struct Lifetime {
    TimeNs first = 0;
    TimeNs last = 0;
    std::size_t observations = 0;
  };
  std::map<std::int64_t, Lifetime> lives;
  for (const auto& observation : tracks) {
    Lifetime& life = lives.try_emplace(observation.id, Lifetime{observation.t, observation.t, 0}).first->second;
    life.last = observation.t;
    ++life.observations;
  }
  double total_s = 0.0;
  double max_s = 0.0;
  for (const auto& [id, life] : lives) {
    total_s += ToSeconds(life.last - life.first);
    max_s = std::max(max_s, ToSeconds(life.last - life.first));
  }
  const auto count = static_cast<double>(lives.size());
  FileDescription description{"tracks", {{"tracks", std::to_string(lives.size())}}};
  auto& values = description.values;
  values.emplace_back("observations", std::to_string(tracks.size()));
  AddSpan(&description, "", tracks.size(), tracks.front().t, tracks.back().t, "observations/s");
  values.emplace_back("mean lifetime", Fixed(total_s / count, 3, "s"));
  values.emplace_back("longest lifetime", Fixed(max_s, 3, "s"));
  values.emplace_back("mean observations a track", Fixed(static_cast<double>(tracks.size()) / count, 1, ""));
  return description;
}

FileDescription DescribeCalibration(const std::filesystem::path& path, bool has_size) {
  const geometry::Calibration c = ReadCalibration(path);
  const bool radtan = c.distortion == geometry::Distortion::kRadTan;
  std::string coefficients;
  for (std::size_t i = 0; i < (radtan ? 5 : 4); ++i) {
    if (i > 0) coefficients += ' ';
    coefficients += FormatNumber(c.coefficients[i]);
  }
  const std::string size = std::to_string(c.width) + " x " + std::to_string(c.height) + " px";
  return {"calibration",
          {{"sensor", size + (has_size ? "" : " (assumed, the file does not say)")},
           {"focal lengths", FormatNumber(c.fx) + " " + FormatNumber(c.fy) + " px"},
           {"principal point", FormatNumber(c.cx) + " " + FormatNumber(c.cy) + " px"},
           {"distortion", radtan ? "radtan k1 k2 p1 p2 k3" : "equidistant k1 k2 k3 k4"},
           {"coefficients", coefficients}}};
}

FileDescription DescribeFolder(const std::filesystem::path& path, const Mask* mask) {
  const SequenceFiles files = FindSequence(path);
  FileDescription description = DescribeFile(files.events, mask);
  auto& values = description.values;
  const auto name = [](const std::optional<std::filesystem::path>& file) { return file ? file->string() : "none"; };
  values.insert(values.begin(), {{"event file", files.events.string()},
                                 {"calibration file", name(files.calibration)},
                                 {"ground truth file", name(files.ground_truth)}});
  return description;
}

}  // namespace

FileDescription DescribeFile(const std::filesystem::path& path, const Mask* mask) {
  switch (const FileKind kind = DetectKind(path)) {
    case FileKind::kFolder:
      return DescribeFolder(path, mask);
    case FileKind::kHdf5:
      return DescribeHdf5(path, mask);
    case FileKind::kEventText:
      return DescribeEventText(path, mask);
    case FileKind::kTrackText:
      return DescribeTracks(path);
    case FileKind::kCalibrationText:
    case FileKind::kCalibrationYaml:
      return DescribeCalibration(path, kind == FileKind::kCalibrationYaml);
    case FileKind::kTrajectoryText: {
      FileDescription description{"trajectory", {}};
      AddTrajectory(&description, "", ReadTum(path));
      return description;
    }
    case FileKind::kKittiPoses: {
      FileDescription description{"KITTI poses without stamps", {}};
      AddPoses(&description, "", ReadKitti(path));
      return description;
    }
    default:
      throw Error(ErrorKind::kInput, path.string() + ": this is " + KindName(kind) +
                                         "; expected events, a trajectory, tracks or a calibration");
  }
}

}  // namespace evo::io
