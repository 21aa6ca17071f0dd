// scripts/sweep.mk and what it takes from configs/.
#include <map>
#include <set>
#include <sstream>

#include "app/evo_run.hpp"
#include "evo/io/calibration_io.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

class SweepTest : public EvoRunTest {
 protected:
  void SetUp() override {
    if (std::system("make --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "make is not installed";
    EvoRunTest::SetUp();
  }

  /// Runs make in the test's folder, whatever the environment says. Returns its exit code.
  int Sweep(const std::string& words, const std::string& program = EVO_RUN) {
    const std::string command = "cd " + Quote(folder) + " && env -i PATH=\"$PATH\" make -f " +
                                Quote(fs::path(EVO_SOURCE_DIR) / "scripts" / "sweep.mk") + " EVO_RUN=" + program + " " +
                                words + " >stdout 2>stderr";
    const int status = std::system(command.c_str());
    out = ReadFile(folder / "stdout");
    err = ReadFile(folder / "stderr");
    return WEXITSTATUS(status);
  }

  /// Names of the runs that the last sweep did.
  std::set<std::string> Done() const {
    std::set<std::string> runs;
    std::istringstream lines(out);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("run        ")) runs.insert(fs::path(line.substr(11)).filename().string());
    }
    return runs;
  }

  /// A recording of its own; --to cuts what is read of it.
  void AddRecording(const std::string& name) const { fs::copy(Sample(), folder / name); }

  /// Lines of the merged table that begin so.
  std::ptrdiff_t CountRows(const std::string& beginning) const {
    std::istringstream lines(ReadFile(folder / "out" / "report" / "runs.csv"));
    std::ptrdiff_t count = 0;
    for (std::string line; std::getline(lines, line);) count += line.starts_with(beginning);
    return count;
  }

  /// Makes files newer than everything so far.
  void Touch(const fs::path& path) const { fs::last_write_time(path, fs::file_time_type::clock::now()); }

  /// A program that does nothing and so is quick.
  std::string Pretender() const {
    const std::string path = Write("pretender", "#!/bin/sh\nexit 0\n");
    fs::permissions(path, fs::perms::owner_all);
    return path;
  }

  void AddFile(const std::string& name) const {
    fs::create_directories((folder / name).parent_path());
    Write(name, "x");
  }
};

TEST_F(SweepTest, OneCorruptSequenceOfSixFailsAndTheOthersGoOn) {
  const std::string six = "-j2 TO=0.8 OPTIONS=--no-plots OUT=out FOLDERS='s1 s2 s3 s4 s5 s6'";
  for (const char* name : {"s1", "s2", "s3", "s4", "s5", "s6"}) AddRecording(name);
  fs::resize_file(folder / "s4" / "street_data.hdf5", 1'000'000);

  EXPECT_EQ(Sweep(six), 2) << out << err;
  EXPECT_EQ(Done().size(), 6u);
  EXPECT_NE(err.find("sweep: 1 of 6 runs failed"), std::string::npos) << err;
  for (const char* name : {"s1", "s2", "s3", "s5", "s6"}) {
    EXPECT_EQ(CountRows(std::string(name) + ",ok,,street,"), 2) << name << " under two alignments";
  }
  EXPECT_EQ(CountRows("s4,"), 1);
  EXPECT_EQ(CountRows("s4,failed,\"exit code 4: s4/street_data.hdf5: "), 1);
  EXPECT_NE(ReadFile(folder / "out/report/index.html").find("1 run failed"), std::string::npos);
  EXPECT_NE(ReadFile(folder / "out/report/runs.tex").find("failed: exit code 4"), std::string::npos);

  EXPECT_EQ(Sweep(six), 2) << "a failed run is tried again, and no other";
  EXPECT_EQ(Done(), std::set<std::string>{"s4"});

  fs::copy_file(Sample("street_data.hdf5"), folder / "s4" / "street_data.hdf5", fs::copy_options::overwrite_existing);
  EXPECT_EQ(Sweep(six), 0) << err;
  EXPECT_EQ(Done(), std::set<std::string>{"s4"});
  EXPECT_EQ(CountRows("s4,ok,,street,"), 2);

  EXPECT_EQ(Sweep(six), 0) << err;
  EXPECT_EQ(Done(), std::set<std::string>{}) << "nothing has changed";

  Touch(folder / "s2" / "street_gt.hdf5");
  EXPECT_EQ(Sweep(six), 0) << err;
  EXPECT_EQ(Done(), std::set<std::string>{"s2"});

  EXPECT_EQ(Sweep(six + " SET=tracker.features=100 SEQUENCES= FOLDERS='s1 s2'"), 0) << err;
  EXPECT_EQ(Done(), (std::set<std::string>{"s1", "s2"})) << "other arguments";
  EXPECT_EQ(CountRows(""), 5);
}

TEST_F(SweepTest, NewProgramOrConfigurationRunsAgain) {
  AddRecording("s1");
  AddRecording("s2");
  const std::string program = Pretender();
  const std::string words = "FOLDERS='s1 s2' CONFIG=" + Write("mine.yaml", "");
  EXPECT_EQ(Sweep(words, program), 0) << err;
  EXPECT_EQ(Done().size(), 2u);
  EXPECT_EQ(Sweep(words, program), 0) << err;
  EXPECT_EQ(Done().size(), 0u);
  Touch(program);
  EXPECT_EQ(Sweep(words, program), 0) << err;
  EXPECT_EQ(Done().size(), 2u);
  Touch(folder / "mine.yaml");
  EXPECT_EQ(Sweep(words, program), 0) << err;
  EXPECT_EQ(Done().size(), 2u);
}

TEST_F(SweepTest, DataSetsKnowTheirFiles) {
  AddFile("m/outdoor_day/outdoor_day1_data.hdf5");
  AddFile("m/outdoor_day/outdoor_day2_data.hdf5");
  AddFile("m/outdoor_night/outdoor_night3_data.hdf5");
  AddFile("m/indoor_flying/indoor_flying4_data.hdf5");
  AddFile("m/indoor_flying/indoor_flying_calib/camchain-imucam-indoor_flying.yaml");
  AddFile("u/shapes_6dof/events.txt");
  AddFile("u/shapes_6dof/groundtruth.txt");
  AddFile("u/urban/events.txt");
  EXPECT_EQ(Sweep("-j4 MVSEC=m UZH=u OUT=out", Pretender()), 0) << err;
  EXPECT_EQ(Done(), (std::set<std::string>{"outdoor_day1", "outdoor_day2", "outdoor_night3", "indoor_flying4",
                                           "shapes_6dof", "urban"}));
  EXPECT_NE(out.find("not found: outdoor_night1 (m/outdoor_night/outdoor_night1_data.hdf5)"), std::string::npos) << out;
  const std::string configs = std::string(EVO_SOURCE_DIR) + "/configs/";
  const std::map<std::string, std::string> expected{
      {"outdoor_day1", "m/outdoor_day/outdoor_day1_data.hdf5 --calibration " + configs +
                           "calibrations/mvsec_outdoor_day.yaml --ground-truth m/outdoor_day/outdoor_day1_gt.hdf5 "
                           "--ground-truth-source loam "},
      {"outdoor_day2", "m/outdoor_day/outdoor_day2_data.hdf5 --calibration " + configs +
                           "calibrations/mvsec_outdoor_day.yaml --ground-truth m/outdoor_day/outdoor_day2_gt.hdf5 "
                           "--ground-truth-source loam --from 12 --to 72 "},
      {"outdoor_night3",
       "m/outdoor_night/outdoor_night3_data.hdf5 --calibration m/outdoor_night/camchain-imucam-outdoor_night.yaml "
       "--ground-truth m/outdoor_night/outdoor_night3_gt.hdf5 --ground-truth-source loam "},
      {"indoor_flying4",
       "m/indoor_flying/indoor_flying4_data.hdf5 --calibration "
       "m/indoor_flying/indoor_flying_calib/camchain-imucam-indoor_flying.yaml --ground-truth "
       "m/indoor_flying/indoor_flying4_gt.hdf5 --ground-truth-source cartographer "},
      {"shapes_6dof",
       "u/shapes_6dof/events.txt --calibration u/shapes_6dof/calib.txt --ground-truth "
       "u/shapes_6dof/groundtruth.txt "},
      {"urban", "u/urban/events.txt --calibration u/urban/calib.txt "}};
  for (const auto& [name, arguments] : expected) {
    EXPECT_EQ(ReadFile(folder / "out/.arguments" / name),
              "run --events " + arguments + "--config " + configs + "default.yaml\n");
  }
}

TEST_F(SweepTest, MissingSequencesAreFailures) {
  EXPECT_EQ(Sweep("MVSEC=m SEQUENCES=outdoor_night2 OUT=out"), 2);
  EXPECT_EQ(CountRows("outdoor_night2,failed,exit code 4: "), 1) << err;
  EXPECT_EQ(Sweep("FOLDERS=absent OUT=out"), 2);
  EXPECT_EQ(CountRows("absent,failed,exit code 4: absent: no such file"), 1) << err;
}

TEST_F(SweepTest, DeletesOnlyResultsOfSweeps) {
  fs::create_directory(folder / "recordings");
  AddRecording("recordings/street");
  EXPECT_EQ(Sweep("FOLDERS=recordings/street OUT=recordings"), 2);
  EXPECT_NE(err.find("not the result of a sweep"), std::string::npos) << err;
  EXPECT_TRUE(fs::exists(folder / "recordings/street/street_data.hdf5"));
}

TEST_F(SweepTest, ErrorsAreReported) {
  EXPECT_EQ(Sweep(""), 2);
  EXPECT_NE(err.find("nothing to run"), std::string::npos) << err;
  EXPECT_EQ(Sweep("MVSEC=m SEQUENCES=outdoor_day9"), 2);
  EXPECT_NE(err.find("no data set has a sequence outdoor_day9"), std::string::npos) << err;
  EXPECT_EQ(Sweep("SEQUENCES=outdoor_day1"), 2);
  EXPECT_NE(err.find("MVSEC="), std::string::npos) << err;
  EXPECT_EQ(Sweep("FOLDERS='a/street b/street'"), 2);
  EXPECT_NE(err.find("two sequences with the name street"), std::string::npos) << err;
  EXPECT_EQ(Sweep("help"), 0);
  EXPECT_NE(out.find("FOLDERS"), std::string::npos);
}

TEST_F(SweepTest, ConfigurationsAreAcceptedAndCalibrationsRead) {
  const fs::path configs = fs::path(EVO_SOURCE_DIR) / "configs";
  int files = 0;
  for (const auto& entry : fs::directory_iterator(configs)) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_EQ(Run("config --check " + Quote(entry.path())), 0) << err;
    ++files;
  }
  for (const auto& entry : fs::directory_iterator(configs / "calibrations")) {
    const geometry::Calibration calibration = io::ReadCalibration(entry.path());
    EXPECT_EQ(calibration.width, 346) << entry.path();
    EXPECT_EQ(calibration.height, 260) << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 4);
}

}  // namespace
}  // namespace evo::app
