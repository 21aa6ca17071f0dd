#include "evo/report/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "evo/core/error.hpp"
#include "evo/core/output_file.hpp"

namespace evo::report {

namespace {

namespace fs = std::filesystem;

constexpr double kPdfWidthInches = 7.0;

/// A temporary folder beside the results in which gnuplot works.
class WorkingFolder {
 public:
  explicit WorkingFolder(const fs::path& parent) : path_(parent / ("plot.part" + std::to_string(::getpid()))) {
    std::error_code failure;
    fs::create_directories(path_, failure);
    if (failure) throw Error(ErrorKind::kOutput, path_.string() + ": cannot create the folder: " + failure.message());
  }
  ~WorkingFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string Script(const std::string& name, const Figure& figure) {
  return fmt::format(
      "# 'gnuplot {0}.gp' in this folder draws {0}.svg and {0}.pdf again.\n"
      "do for [ending in 'svg pdf'] {{\n"
      "reset\n"
      "if (ending eq 'svg') {{\n"
      "set terminal svg noenhanced size {1},{2} font 'DejaVu Sans,14' background '#ffffff'\n"
      "}} else {{\n"
      "set terminal pdfcairo noenhanced size {3},{4:.6g} font 'DejaVu Sans,13' linewidth 1.2\n"
      "}}\n"
      "set output '{0}.'.ending\n"
      "{5}"
      "unset output\n"
      "}}\n",
      name, figure.width, figure.height, kPdfWidthInches, kPdfWidthInches * figure.height / figure.width,
      figure.script);
}

std::string ReadText(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns an error message, empty on success. The output of gnuplot goes to `log` in `folder`.
std::string RunGnuplot(const fs::path& folder, const std::string& script, const std::string& log) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawnattr_init(&attributes);
  ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  ::posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  sigset_t none;  // the child must receive the signals that this process blocks
  ::sigemptyset(&none);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  std::string program = "gnuplot";
  std::string argument = script;
  char* const arguments[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  const int failure = ::posix_spawnp(&child, program.c_str(), &actions, &attributes, arguments, environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  if (failure) return failure == ENOENT ? "gnuplot is not installed; install gnuplot-nox" : std::strerror(failure);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  std::string message = ReadText(folder / log);
  for (char& c : message) {
    if (c == '\n') c = ' ';
  }
  return "gnuplot failed: " + message;
}

/// Cairo writes the time of day into a PDF; equal runs must give equal bytes.
void ResetCreationDate(std::string* pdf) {
  const std::string key = "/CreationDate (D:";
  const auto found = pdf->find(key);
  if (found == std::string::npos) return;
  for (std::size_t i = found + key.size(); i < pdf->size() && (*pdf)[i] >= '0' && (*pdf)[i] <= '9'; ++i) {
    (*pdf)[i] = "20000101000000"[(i - found - key.size()) % 14];
  }
}

}  // namespace

void Gnuplot::Draw(const std::string& name, const Figure& figure) {
  const std::string script = Script(name, figure);
  WriteText(folder_ / (name + ".dat"), figure.data);
  WriteText(folder_ / (name + ".gp"), script);
  if (!available_) return;
  const WorkingFolder work(folder_);
  WriteText(work.path() / (name + ".dat"), figure.data);
  WriteText(work.path() / (name + ".gp"), script);
  const std::string failure = RunGnuplot(work.path(), name + ".gp", "log");
  if (!failure.empty()) {
    available_ = false;
    spdlog::warn("no plots in {}: {}; 'gnuplot {}.gp' in that folder draws them later", folder_.string(), failure,
                 name);
    return;
  }
  WriteText(folder_ / (name + ".svg"), ReadText(work.path() / (name + ".svg")));
  std::string pdf = ReadText(work.path() / (name + ".pdf"));
  ResetCreationDate(&pdf);
  WriteText(folder_ / (name + ".pdf"), pdf);
}

}  // namespace evo::report
