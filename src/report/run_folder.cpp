#include "evo/report/run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "evo/core/error.hpp"
#include "report/tables/run_measures.hpp"
#include "report/text_file.hpp"

namespace evo::report {

namespace fs = std::filesystem;

namespace {

Error Failure(const fs::path& path, std::size_t line, const std::string& what) {
  return Error(ErrorKind::kInput, fmt::format("{}:{}: {}", path.string(), line, what));
}

/// Reads summary.csv and checks that its measures are numbers.
CsvTable ReadSummary(const fs::path& path) {
  CsvTable table = ReadCsv(path);
  const auto alignment = table.Find("alignment");
  if (!alignment) throw Failure(path, 1, "no column 'alignment'; this is not a summary.csv of evo-run");
  if (table.rows.empty()) throw Failure(path, 1, "no row under the header");
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto same = [&](const auto& row) { return row[*alignment] == table.rows[i][*alignment]; };
    if (std::any_of(table.rows.begin(), table.rows.begin() + static_cast<std::ptrdiff_t>(i), same)) {
      throw Failure(path, table.lines[i], "alignment " + table.rows[i][*alignment] + " has a row already");
    }
    for (const auto& measure : RunMeasures()) {
      const auto column = table.Find(measure.column);
      if (!column || table.rows[i][*column].empty() || ParseMeasure(table.rows[i][*column])) continue;
      throw Failure(path, table.lines[i], std::string(measure.column) + " is not a number");
    }
  }
  return table;
}

/// Reads the numbers of lifetime.csv that a comparison shows.
std::vector<std::pair<std::string, std::string>> ReadLifetimes(const fs::path& path) {
  const CsvTable table = ReadCsv(path);
  const auto quantity = table.Find("quantity");
  const auto unit = table.Find("unit");
  const auto value = table.Find("value");
  if (!quantity || !unit || !value) throw Failure(path, 1, "this is not a lifetime.csv of evo-run");
  const std::map<std::pair<std::string, std::string>, std::string> wanted{
      {{"tracks", "count"}, "lifetime_tracks"},
      {{"mean", "frames"}, "lifetime_mean_frames"},
      {{"standard_deviation", "frames"}, "lifetime_std_frames"},
      {{"mean", "s"}, "lifetime_mean_s"},
      {{"standard_deviation", "s"}, "lifetime_std_s"}};
  std::vector<std::pair<std::string, std::string>> found;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    const auto name = wanted.find({row[*quantity], row[*unit]});
    if (name == wanted.end()) continue;
    const std::string& cell = row[*value];
    if (!cell.empty() && !ParseMeasure(cell)) throw Failure(path, table.lines[i], "the value is not a number");
    found.emplace_back(name->second, cell);
  }
  if (found.size() != wanted.size()) throw Failure(path, 1, "rows are missing; is the file cut short?");
  return found;
}

/// Reads failure.txt as one line.
std::string ReadFailure(const fs::path& path) {
  std::istringstream lines(ReadTextFile(path));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) text += (text.empty() ? "" : "; ") + line;
  }
  return text.empty() ? "failure.txt gives no reason" : text;
}

std::vector<std::string> ReadWarnings(const fs::path& path) {
  std::istringstream lines(ReadTextFile(path));
  std::vector<std::string> warnings;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("warning:")) warnings.push_back(line);
  }
  return warnings;
}

std::vector<fs::path> FilesNamed(const fs::path& folder, const std::string& prefix, const std::string& suffix) {
  std::vector<fs::path> files;
  std::error_code none;  // the folder may be missing
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) && name.ends_with(suffix) && entry.is_regular_file(none))
      files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

RunFolder ReadRunFolder(const fs::path& path) {
  std::error_code unreadable;
  if (!fs::is_directory(path, unreadable))
    throw Error(ErrorKind::kInput, path.string() + ": no such folder; check the name");
  const auto has = [&](const char* name) { return fs::exists(path / name, unreadable); };
  RunFolder run;
  run.path = path;
  if (has("failure.txt")) {
    run.failure = ReadFailure(path / "failure.txt");
  } else if (!has("manifest.json")) {
    if (!has("summary.csv") && !has("lifetime.csv")) {
      throw Error(ErrorKind::kInput, path.string() +
                                         ": holds no manifest.json, summary.csv, lifetime.csv or failure.txt; give the "
                                         "--out folder of a run");
    }
    run.failure = "no manifest.json: the run did not complete";
  }
  if (has("manifest.json")) run.manifest = ReadManifest(path / "manifest.json");
  if (has("summary.csv") && run.failure.empty()) run.summary = ReadSummary(path / "summary.csv");
  if (has("lifetime.csv")) run.lifetimes = ReadLifetimes(path / "lifetime.csv");
  if (has("log.txt")) run.warnings = ReadWarnings(path / "log.txt");
  run.plots = FilesNamed(path / "plots", "", ".svg");
  run.sheets = FilesNamed(path / "images", "four_frames_", ".png");
  return run;
}

/// The last `parts` components of a path.
std::string Tail(const fs::path& path, int parts) {
  fs::path tail;
  fs::path rest = path;
  for (int i = 0; i < parts && rest.has_filename(); ++i, rest = rest.parent_path()) {
    tail = tail.empty() ? rest.filename() : rest.filename() / tail;
  }
  return tail.string();
}

/// Unique names of different folders, each as short as possible.
std::vector<std::string> UniqueNames(const std::vector<fs::path>& paths) {
  std::vector<std::string> names;
  for (const auto& path : paths) {
    int parts = 1;
    const auto shared = [&] {
      return std::ranges::count_if(paths, [&](const auto& other) { return Tail(other, parts) == Tail(path, parts); }) >
             1;
    };
    while (shared()) ++parts;
    names.push_back(Tail(path, parts));
  }
  return names;
}

}  // namespace

std::vector<RunFolder> ReadRunFolders(const std::vector<fs::path>& paths) {
  std::vector<fs::path> folders;
  std::vector<RunFolder> runs;
  for (const auto& path : paths) {
    std::error_code failure;
    const fs::path folder = fs::canonical(path, failure);
    if (!failure && std::ranges::find(folders, folder) != folders.end()) continue;
    runs.push_back(ReadRunFolder(path));
    folders.push_back(folder);
  }
  const auto names = UniqueNames(folders);
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].name = names[i];
  return runs;
}

}  // namespace evo::report
