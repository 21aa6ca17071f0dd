// evo-run simulate with bad scenes, options and disks.
#include <fcntl.h>
#include <signal.h>

#include "app/simulate.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

/// A failed run leaves the folder as it was.
class SimulateFailureTest : public SimulateCommandTest {
 protected:
  /// Starts a long run, ends it with `signal` once it writes, and returns how it ended.
  int Interrupt(const std::string& format, int signal) {
    const std::string scene = SceneFile("slider.yaml");
    const std::string result = Path("result");
    const pid_t child = ::fork();
    if (child == 0) {
      const int null = ::open("/dev/null", O_WRONLY);
      ::dup2(null, STDOUT_FILENO);
      ::dup2(null, STDERR_FILENO);
      ::execl(EVO_RUN, EVO_RUN, "simulate", scene.c_str(), "--format", format.c_str(), "--out", result.c_str(), "--set",
              "motion.slider.duration_s=600", "--preview-every", "0.05", static_cast<char*>(nullptr));
      ::_exit(1);
    }
    for (int i = 0; i < 3000 && CountFiles(result) < 4; ++i) ::usleep(10'000);
    EXPECT_GE(CountFiles(result), 4);
    ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
  }
};

TEST_F(SimulateFailureTest, InterruptionLeavesNothing) {
  for (const char* format : {"mvsec", "uzh"}) {
    for (const int signal : {SIGINT, SIGTERM}) {
      const int status = Interrupt(format, signal);
      EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << format << ' ' << status;
      EXPECT_EQ(CountFiles(folder / "result"), 0) << format;
    }
  }
}

TEST_F(SimulateFailureTest, FullDiskLeavesNothing) {
  for (const char* format : {"mvsec", "uzh"}) {
    EXPECT_EQ(Refusal(Small("slider", "result") + "-q --duration 0.3 --format " + format, kFullDisk), 8);
    EXPECT_NE(err.find("disk full"), std::string::npos) << err;
    EXPECT_FALSE(fs::exists(folder / "result"));
  }
}

TEST_F(SimulateFailureTest, EarlierResultsStayUntilTheNewOnesAreComplete) {
  const std::string words = Small("slider", "result") + "-q --format uzh --duration 0.06 --preview-every 0.05 ";
  ASSERT_EQ(Run(words + "--set simulation.depth_hz=100"), 0) << err;
  const auto before = Checksums("result");
  EXPECT_EQ(Refusal(words), 8);
  EXPECT_NE(err.find("--force"), std::string::npos) << err;
  EXPECT_EQ(Refusal(words + "--force", kFullDisk), 8);
  EXPECT_EQ(Checksums("result"), before);
  Write("result/notes.txt", "kept");
  Write("result/images/mine.png", "kept");
  ASSERT_EQ(Run(words + "--force --set simulation.depth_hz=0 --set simulation.image_hz=10"), 0) << err;
  const auto after = Checksums("result");
  EXPECT_FALSE(after.contains("depth_gt.hdf5"));
  EXPECT_FALSE(after.contains("images/frame_00000001.png"));
  EXPECT_TRUE(after.contains("notes.txt") && after.contains("images/mine.png"));
}

TEST_F(SimulateFailureTest, UnusableOutputFolderIsRefused) {
  Write("file", "in the way");
  EXPECT_EQ(Refusal(Small("slider", "file")), 8);
  EXPECT_EQ(Refusal(Small("slider", "file/result")), 8);
  EXPECT_EQ(Refusal("simulate " + Quote(SceneFile("slider.yaml"))), 2);
  EXPECT_NE(err.find("--out"), std::string::npos) << err;
}

TEST_F(SimulateFailureTest, BadScenesAreRefused) {
  const auto expect = [&](const std::string& text, const std::string& part) {
    ExpectRefusal("simulate " + Quote(Write("scene.yaml", text)), 3, part);
    EXPECT_NE(err.find("scene.yaml"), std::string::npos) << err;
  };
  expect("scene:\n  knd: room\n", "scene.yaml:2: unknown parameter 'scene.knd'; did you mean 'scene.kind'?");
  expect("scene:\n  seed: many\n", "scene.yaml:2: 'scene.seed' is 'many' but must be a whole number");
  expect("scene:\n  kind: sea\n", "street, room, slider");
  expect("sensor:\n  threshold_on: 99\n", "must be a number in");
  expect("sensor:\n  threshold_on: .nan\n", "must be a number in");
  expect("scene:\n  seed: 1\n  seed: 2\n", "scene.yaml:3: 'scene.seed' comes twice");
  expect("a: [1,\n", "not valid YAML");
  expect("- 1\n", "'name: value'");
  expect("", "empty file");
  expect(std::string("\x7F"
                     "ELF\0\0",
                     6),
         "no text");
  expect("scene:\n  kind: room\n", "has no road");
  ExpectRefusal("simulate " + Quote(folder / "absent.yaml"), 3, "absent.yaml: cannot read");
  ExpectRefusal("simulate " + Quote(folder), 3, "is a folder");
}

TEST_F(SimulateFailureTest, BadOptionsAreRefused) {
  const std::string words = "simulate " + Quote(SceneFile("slider.yaml"));
  for (const char* duration : {"0", "-1", "nan", "inf", "1e9", "soon"}) {
    ExpectRefusal(words + " --duration=" + duration, 2, std::string("'") + duration + "' is not a number from 0.001");
  }
  ExpectRefusal(words + " --duration 100", 2, "raise motion.slider.duration_s");
  ExpectRefusal(words + " --format hdf4", 2, "--format");
  ExpectRefusal(words + " --seed=-1", 2, "--seed");
  ExpectRefusal(words + " --preview-every nan", 2, "--preview-every");
  ExpectRefusal(words + " --preview-every 1 --set simulation.image_hz=0", 2, "simulation.image_hz");
  ExpectRefusal(words + " --set output.flow=true --set simulation.depth_hz=0", 3, "simulation.depth_hz");
  ExpectRefusal(words + " --format uzh --set scene.calibration=davis346", 3, "write a camchain instead");
}

TEST_F(SimulateFailureTest, BadCalibrationsAreRefused) {
  const auto expect = [&](const std::string& calibration, int code, const std::string& part) {
    ExpectRefusal("simulate --set scene.calibration=" + Quote(calibration), code, part);
  };
  expect(Path("absent.yaml"), 4, "absent.yaml: no such file");
  expect("", 3, "scene.calibration");
  expect(Write("empty.yaml", ""), 4, "empty file");
  std::string huge = kSmallCamera;
  huge.replace(huge.find("[120, 90]"), 9, "[60000, 60000]");
  expect(Write("huge.yaml", huge), 4, "huge.yaml: a sensor of 60000 x 60000 px is too large");
}

TEST_F(SimulateFailureTest, BadMotionFilesAreRefused) {
  const auto expect = [&](const std::string& poses, int code, const std::string& part, const std::string& more = "") {
    ExpectRefusal("simulate --set scene.kind=room --set motion.kind=file --set motion.file=" +
                      Quote(Write("motion.txt", poses)) + more,
                  code, part);
  };
  const std::string first = "0 0 0 0 0 0 0 1\n";
  const std::string second = "1 0 0 1 0 0 0 1\n";
  expect("", 4, "empty file");
  expect(first, 4, "a single pose is no motion");
  expect(second + first, 4, "motion.txt:2: the stamp");
  expect(first + first, 4, "motion.txt:2: the stamp");
  expect(first + "1 nan 0 0 0 0 0 1\n", 4, "motion.txt:2: 'nan'");
  expect(first + "1 0 0 0 0 0 0 2\n", 4, "motion.txt:2: the quaternion");
  expect(first + second, 2, "give a longer trajectory", " --duration 2");
  ExpectRefusal("simulate --set scene.kind=room --set motion.kind=file", 3, "motion.file names none");
  ExpectRefusal("simulate --set scene.kind=room --set motion.kind=file --set motion.file=" + Quote(folder), 4,
                "folder");
}

}  // namespace
}  // namespace evo::app
