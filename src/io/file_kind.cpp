#include "evo/io/file_kind.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <system_error>

#include "evo/core/error.hpp"
#include "io/byte_source.hpp"
#include "io/hdf5/hdf5.hpp"
#include "io/text_lines.hpp"

namespace evo::io {

namespace {

constexpr std::size_t kProbedBytes = std::size_t{64} << 10;
constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

bool IsBinary(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return (c >= 0 && c < '\t') || (c > '\r' && c < ' ') || c == '\x7f'; });
}

FileKind KindOfRow(std::string_view line) {
  const bool commas = line.find(',') != std::string_view::npos;
  const auto fields = commas ? SplitAtCommas(line) : SplitFields(line);
  const auto is_number = [](std::string_view field) { return ParseFinite(field).has_value(); };
  if (!std::ranges::all_of(fields, is_number)) return FileKind::kOtherText;
  if (commas) return fields.size() == 5 ? FileKind::kTrackText : FileKind::kOtherText;
  if (fields.size() == 8) return FileKind::kTrajectoryText;
  if (fields.size() == 12) return FileKind::kKittiPoses;
  if (fields.size() == 9) return FileKind::kCalibrationText;
  if (fields.size() != 4) return FileKind::kOtherText;
  // 't x y p' has whole pixels and a polarity; 'id t x y' a whole id and, in any recording, a stamp with decimals.
  const auto polarity = ParseInteger(fields[3]);
  if (ParseInteger(fields[1]) && ParseInteger(fields[2]) && polarity && *polarity >= -1 && *polarity <= 1) {
    return FileKind::kEventText;
  }
  const auto id = ParseFinite(fields[0]);
  return *id >= 0 && *id == static_cast<double>(static_cast<std::int64_t>(*id)) && !ParseInteger(fields[1])
             ? FileKind::kTrackText
             : FileKind::kOtherText;
}

FileKind KindOfText(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = Trim(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with("# id timestamp x y")) return FileKind::kTrackText;
    if (line.starts_with("cam0:")) return FileKind::kCalibrationYaml;
    if (line.empty() || line.front() == '#') continue;
    const FileKind kind = KindOfRow(line);
    if (kind != FileKind::kOtherText) return kind;
    // A camchain may begin with other keys; a table with a faulty first row stays a text of unknown kind.
    return text.find("\ncam0:") != std::string_view::npos || text.starts_with("cam0:") ? FileKind::kCalibrationYaml
                                                                                       : FileKind::kOtherText;
  }
  return FileKind::kOtherText;
}

}  // namespace

const char* KindName(FileKind kind) {
  switch (kind) {
    case FileKind::kHdf5:
      return "an HDF5 file";
    case FileKind::kEventText:
      return "an event text";
    case FileKind::kTrajectoryText:
      return "a trajectory text";
    case FileKind::kKittiPoses:
      return "a KITTI pose file";
    case FileKind::kTrackText:
      return "a track file";
    case FileKind::kCalibrationText:
      return "a UZH calib.txt";
    case FileKind::kCalibrationYaml:
      return "a Kalibr calibration";
    case FileKind::kOtherText:
      return "a text of unknown kind";
    case FileKind::kPng:
      return "a PNG image";
    case FileKind::kBinary:
      return "a binary file";
    case FileKind::kEmpty:
      return "an empty file";
    case FileKind::kFolder:
      return "a folder";
  }
  return "a file";
}

FileKind DetectKind(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) {
    throw Error(ErrorKind::kInput, path.string() + ": no such file; check the name");
  }
  if (std::filesystem::is_directory(path)) return FileKind::kFolder;
  const ByteSource file(path);
  std::string text(kProbedBytes, '\0');
  text.resize(file.Read(0, text.size(), text.data()));
  if (text.empty()) return FileKind::kEmpty;
  if (text.starts_with(kPngSignature)) return FileKind::kPng;
  hdf5::SetUp();
  if (H5Fis_hdf5(path.c_str()) > 0) return FileKind::kHdf5;
  if (IsBinary(text)) return FileKind::kBinary;
  return KindOfText(text);
}

void RequireKind(const std::filesystem::path& path, std::initializer_list<FileKind> accepted, const char* expected) {
  const FileKind kind = DetectKind(path);
  if (kind == FileKind::kOtherText || std::ranges::find(accepted, kind) != accepted.end()) return;
  throw Error(ErrorKind::kInput, path.string() + ": this is " + KindName(kind) + "; expected " + expected);
}

}  // namespace evo::io
