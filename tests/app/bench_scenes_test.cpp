// scripts/bench_scenes.sh, on a slider that is fast and short.
#include <sstream>
#include <vector>

#include "app/bench_script.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

class BenchScenesTest : public BenchScriptTest {
 protected:
  BenchScenesTest() : BenchScriptTest("bench_scenes") {}

  bool Ran() const { return CountRuns() > 0; }

  /// Cells of the only row of scenes.csv.
  std::vector<std::string> Row() const {
    std::istringstream csv(ReadFile(folder / "out/bench_scenes/scenes.csv"));
    std::string line;
    std::getline(csv, line);
    std::getline(csv, line);
    std::istringstream stream(line + ',');
    std::vector<std::string> cells;
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
  }

  void WriteScene(const std::string& length_m) const { BenchScriptTest::WriteScene("swift", length_m, "0.5"); }
};

TEST_F(BenchScenesTest, OnlyWhatHasChangedIsDoneAgain) {
  WriteScene("0.5");
  ASSERT_EQ(Bench("swift.yaml"), 0) << err;
  EXPECT_NE(out.find("\nswift "), std::string::npos) << out;
  const auto row = Row();
  ASSERT_EQ(row.size(), 22u);
  EXPECT_EQ(row[0] + ' ' + row[1] + ' ' + row[2], "swift 1 0.5");
  for (std::size_t i : {3, 4, 5, 6, 7, 8, 9, 11, 15, 17, 18, 19, 20}) EXPECT_GT(std::stod(row[i]), 0.0) << i;
  EXPECT_EQ(row[21], "") << "no failure";

  ASSERT_EQ(Bench("swift.yaml --delete"), 0) << err;
  EXPECT_FALSE(Simulated() || Ran()) << err;
  EXPECT_EQ(Row(), row);
  EXPECT_EQ(CountFiles(folder / "out/scenes/swift_1_0.5"), 2) << "the manifest and what it was made from";
  ASSERT_EQ(Bench("swift.yaml"), 0) << err;
  EXPECT_FALSE(Simulated() || Ran()) << err;

  ASSERT_EQ(Bench("swift.yaml --set tracker.features=100"), 0) << err;
  EXPECT_TRUE(Simulated() && Ran()) << "the sequence was deleted\n" << err;
  ASSERT_EQ(Bench("swift.yaml"), 0) << err;
  EXPECT_TRUE(!Simulated() && Ran()) << err;
}

TEST_F(BenchScenesTest, ARunThatFailsHasARow) {
  WriteScene("0.01");
  EXPECT_EQ(Bench("swift.yaml"), 1) << out;
  EXPECT_NE(out.find("exit code 6: "), std::string::npos) << out;
  EXPECT_EQ(Bench("swift.yaml --simulate-only"), 0) << err;
  EXPECT_FALSE(Simulated() || Ran()) << err;
}

TEST_F(BenchScenesTest, OtherFoldersAreLeftAloneButNotOnesThatWereInterrupted) {
  WriteScene("0.01");
  fs::create_directories(folder / "out/scenes/swift_1_0.5");
  Write("out/scenes/swift_1_0.5/events.txt", "mine");
  EXPECT_EQ(Bench("swift.yaml"), 2);
  EXPECT_NE(err.find("was not made by this script"), std::string::npos) << err;
  EXPECT_EQ(ReadFile(folder / "out/scenes/swift_1_0.5/events.txt"), "mine");
  Write("out/scenes/swift_1_0.5/made_from.txt", "");
  EXPECT_EQ(Bench("swift.yaml --simulate-only"), 0) << err;
  EXPECT_TRUE(Simulated());
  EXPECT_EQ(Bench("nowhere"), 2);
  EXPECT_EQ(Bench("--speed 3"), 2);
}

}  // namespace
}  // namespace evo::app
