#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace evo::app {

/// The program as users call it, and a folder of its own for each test, removed afterwards.
class EvoRunTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  /// Runs evo-run with shell words; fills out and err and returns the exit code. `before` are shell commands that run
  /// in the same shell first.
  int Run(const std::string& words, const std::string& before = "") {
    const std::string command =
        "(" + before + " exec '" EVO_RUN "' " + words + ") >" + Quote(Path("stdout")) + " 2>" + Quote(Path("stderr"));
    const int status = std::system(command.c_str());
    out = ReadFile(folder / "stdout");
    err = ReadFile(folder / "stderr");
    return WEXITSTATUS(status);
  }

  /// As Run, and the error must be one line.
  int Refusal(const std::string& words, const std::string& before = "") {
    const int code = Run(words, before);
    EXPECT_TRUE(err.starts_with("evo-run: error: ")) << err;
    EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
    EXPECT_EQ(out, "");
    return code;
  }

  std::string Path(const std::string& name) const { return (folder / name).string(); }

  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
    return Path(name);
  }

  static std::string ReadFile(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  static std::string Quote(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

  /// The bundled street by day, in which --events finds all files, or one file of it.
  static std::filesystem::path Sample(const std::string& name = "") { return BundledSequence("street") / name; }
  /// street, night or handheld.
  static std::filesystem::path BundledSequence(const std::string& name) {
    return std::filesystem::path(EVO_SOURCE_DIR) / "data_samples" / name;
  }

  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() /
      ("evo_app_" + std::to_string(::getpid()) + "_" + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  std::string out;
  std::string err;
};

/// Files, not folders, below `folder`, which need not exist.
inline std::ptrdiff_t CountFiles(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder)) return 0;
  const std::filesystem::recursive_directory_iterator files(folder);
  return std::count_if(begin(files), end(files), [](const auto& entry) { return entry.is_regular_file(); });
}

}  // namespace evo::app
