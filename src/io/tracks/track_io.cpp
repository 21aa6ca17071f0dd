#include "evo/io/track_io.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "evo/core/error.hpp"
#include "evo/io/file_kind.hpp"
#include "io/text_lines.hpp"

namespace evo::io {

namespace {

constexpr char kExpected[] = "a track file of rows 'id t x y' or 't,x,y,theta,id'";
constexpr double kMaxId = 9e15;  // whole numbers up to here are exact in a double

struct Row {
  events::TrackObservation observation;
  std::size_t line = 0;
};

/// numpy writes whole numbers as 12.0 or 1.2e+01.
std::int64_t ParseId(const TextLines& lines, std::string_view text) {
  auto id = ParseInteger(text);
  const auto number = ParseFinite(text);
  if (!id && number && std::abs(*number) < kMaxId && *number == std::floor(*number)) {
    id = static_cast<std::int64_t>(*number);
  }
  if (!id || *id < 0) throw lines.Failure("the id " + Quote(text) + " is not a whole number from 0 on");
  return *id;
}

events::TrackObservation ParseRow(const TextLines& lines, std::string_view line, bool haste) {
  const auto fields = haste ? SplitAtCommas(line) : SplitFields(line);
  if (fields.size() != (haste ? 5u : 4u)) {
    throw lines.Failure(std::string("expected ") + (haste ? "'t,x,y,theta,id'" : "'id t x y'") + ", found " +
                        Quote(line));
  }
  const std::size_t first = haste ? 0 : 1;
  const auto t = ParseTime(fields[first]);
  if (!t) throw lines.Failure("the stamp " + Quote(fields[first]) + " is not a time in seconds");
  const auto x = ParseFinite(fields[first + 1]);
  const auto y = ParseFinite(fields[first + 2]);
  if (!x || !y) throw lines.Failure("the position " + Quote(fields[first + (x ? 2 : 1)]) + " is not a finite number");
  return {ParseId(lines, fields[haste ? 4 : 0]), *t, *x, *y};
}

/// Keeps one of the rows with the same id and stamp. `rows` is sorted, equal ones in the order of the file.
events::Tracks Unique(const TextLines& lines, const std::vector<Row>& rows, bool keep_last) {
  events::Tracks tracks;
  tracks.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const events::TrackObservation& now = rows[i].observation;
    if (tracks.empty() || tracks.back().id != now.id || tracks.back().t != now.t) {
      tracks.push_back(now);
    } else if (keep_last) {
      tracks.back() = now;
    } else if (tracks.back().x != now.x || tracks.back().y != now.y) {
      throw lines.Failure(rows[i].line, "track " + std::to_string(now.id) + " is at " + FormatTime(now.t) +
                                            " s here and elsewhere on line " + std::to_string(rows[i - 1].line) +
                                            "; were two files joined?");
    }
  }
  return tracks;
}

/// Several times faster than fmt.
void AppendPixel(double px, std::string* line) {
  std::array<char, 32> text;  // fits any position that is written
  const auto end = std::to_chars(text.data(), text.data() + text.size(), px, std::chars_format::fixed, 4).ptr;
  *line += ' ';
  line->append(text.data(), end);
}

}  // namespace

events::Tracks ReadTracks(const std::filesystem::path& path) {
  // A row of an event text may read as a track's: the rows decide, below.
  RequireKind(path, {FileKind::kTrackText, FileKind::kEventText}, kExpected);
  TextLines lines(path);
  std::vector<Row> rows;
  std::string_view line;
  bool haste = false;
  while (lines.Next(&line)) {
    if (rows.empty()) haste = line.find(',') != std::string_view::npos;
    rows.push_back({ParseRow(lines, line, haste), lines.number()});
  }
  if (rows.empty()) throw Error(ErrorKind::kInput, path.string() + ": no tracks; expected " + kExpected);
  const auto key = [](const Row& row) { return std::pair(row.observation.t, row.observation.id); };
  std::ranges::stable_sort(rows, {}, key);
  return Unique(lines, rows, haste);
}

void RoundAsWritten(events::Tracks* tracks) {
  constexpr double kSteps = 1e4;
  for (auto& observation : *tracks) {
    observation.x = std::round(observation.x * kSteps) / kSteps;
    observation.y = std::round(observation.y * kSteps) / kSteps;
  }
}

TrackWriter::TrackWriter(std::filesystem::path path, const std::vector<std::string>& comments)
    : path_(std::move(path)), file_(path_) {
  file_.stream() << "# id timestamp x y\n";
  for (const auto& comment : comments) file_.stream() << "# " << comment << '\n';
}

void TrackWriter::Write(std::span<const events::TrackObservation> observations) {
  std::string line;
  for (const auto& observation : observations) {
    if (!(std::abs(observation.x) < 1e9 && std::abs(observation.y) < 1e9)) {
      throw Error(ErrorKind::kInput, path_.string() + ": the position of track " + std::to_string(observation.id) +
                                         " at " + FormatTime(observation.t) + " s is not finite");
    }
    line = std::to_string(observation.id);
    line += ' ';
    line += FormatTime(observation.t);
    AppendPixel(observation.x, &line);
    AppendPixel(observation.y, &line);
    file_.stream() << line << '\n';
  }
  file_.Check();
}

void WriteTracks(const std::filesystem::path& path, const events::Tracks& tracks,
                 const std::vector<std::string>& comments) {
  TrackWriter writer(path, comments);
  writer.Write(tracks);
  writer.Commit();
}

}  // namespace evo::io
