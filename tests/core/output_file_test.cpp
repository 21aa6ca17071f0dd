#include "evo/core/output_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "evo/core/error.hpp"

namespace evo {
namespace {

namespace fs = std::filesystem;

class OutputFileTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  std::string Content(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  fs::path folder = fs::temp_directory_path() / ("evo_output_file_test_" + std::to_string(::getpid()));
};

TEST_F(OutputFileTest, AppearsOnlyOnCommit) {
  const fs::path path = folder / "deep" / "result.txt";
  {
    OutputFile file(path);
    file.stream() << "whole";
    EXPECT_FALSE(fs::exists(path));
    file.Commit();
  }
  EXPECT_EQ(Content(path), "whole");
}

TEST_F(OutputFileTest, LeavesNothingBehindWithoutCommit) {
  const fs::path path = folder / "result.txt";
  { OutputFile(path).stream() << "half"; }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(OutputFileTest, KeepsTheOldFileUntilCommit) {
  const fs::path path = folder / "result.txt";
  std::ofstream(path) << "old";
  { OutputFile(path).stream() << "new"; }
  EXPECT_EQ(Content(path), "old");
}

TEST_F(OutputFileTest, ReportsAFolderThatCannotBeCreated) {
  std::ofstream(folder / "file") << "x";
  try {
    OutputFile file(folder / "file" / "result.txt");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kOutput);
  }
}

TEST_F(OutputFileTest, ReportsAFailedWrite) {
  OutputFile file(folder / "result.txt");
  file.stream().setstate(std::ios::badbit);
  EXPECT_THROW(file.Commit(), Error);
  EXPECT_FALSE(fs::exists(folder / "result.txt"));
}

}  // namespace
}  // namespace evo
