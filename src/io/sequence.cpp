#include "evo/io/sequence.hpp"

#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "evo/core/error.hpp"

namespace evo::io {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDataSuffix = "_data.hdf5";

std::optional<fs::path> IfExists(const fs::path& path) {
  std::error_code failure;
  if (!fs::exists(path, failure)) return std::nullopt;
  return path;
}

std::vector<fs::path> FilesNamed(const fs::path& folder, std::string_view prefix, std::string_view suffix) {
  std::vector<fs::path> found;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) && name.ends_with(suffix)) found.push_back(entry.path());
  }
  if (failure) throw Error(ErrorKind::kInput, folder.string() + ": cannot be read: " + failure.message());
  return found;
}

}  // namespace

SequenceFiles FindSequence(const fs::path& path) {
  std::error_code failure;
  if (!fs::exists(path, failure)) throw Error(ErrorKind::kInput, path.string() + ": no such file; check the name");
  if (!fs::is_directory(path)) return {path, std::nullopt, std::nullopt};
  if (fs::exists(path / "events.txt")) {
    return {path / "events.txt", IfExists(path / "calib.txt"), IfExists(path / "groundtruth.txt")};
  }
  const auto recordings = FilesNamed(path, "", kDataSuffix);
  if (recordings.size() != 1) {
    throw Error(ErrorKind::kInput, path.string() + ": the folder holds no events.txt and " +
                                       (recordings.empty() ? "no" : "more than one") +
                                       " *_data.hdf5; name the event file itself");
  }
  SequenceFiles files{recordings[0], std::nullopt, std::nullopt};
  std::string name = recordings[0].filename().string();
  name.resize(name.size() - kDataSuffix.size());
  files.ground_truth = IfExists(path / (name + "_gt.hdf5"));
  const auto calibrations = FilesNamed(path, "camchain", ".yaml");
  if (calibrations.size() == 1) files.calibration = calibrations[0];
  return files;
}

}  // namespace evo::io
