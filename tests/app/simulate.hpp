#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "app/evo_run.hpp"
#include "evo/core/parameters.hpp"
#include "evo/io/checksum.hpp"
#include "evo/simulation/simulated_run.hpp"

namespace evo::app {

inline constexpr char kSmallCamera[] =
    "cam0:\n  camera_model: pinhole\n  intrinsics: [90, 90, 60, 45]\n  distortion_model: radtan\n"
    "  distortion_coeffs: [-0.2, 0.05, 0.001, -0.001]\n  resolution: [120, 90]\n";

/// The largest file that the shell allows stands for the full disk.
inline constexpr char kFullDisk[] = "trap '' XFSZ; ulimit -f 16;";

class SimulateCommandTest : public EvoRunTest {
 protected:
  static std::filesystem::path SceneFile(const std::string& name) {
    return std::filesystem::path(EVO_SOURCE_DIR) / "configs" / "scenes" / name;
  }

  /// Shell words for a bundled scene, seen by a small camera.
  std::string Small(const std::string& scene, const std::string& result) const {
    return "simulate " + Quote(SceneFile(scene + ".yaml")) +
           " --set scene.calibration=" + Quote(Write("camera.yaml", kSmallCamera)) + " --out " +
           Quote(folder / result) + " ";
  }

  /// The run of Small().
  simulation::SimulatedRun RunOf(const std::string& scene, const std::string& setting = "") const {
    simulation::SceneOptions options;
    Parameters parameters;
    Register(parameters, options);
    parameters.LoadFile(SceneFile(scene + ".yaml"));
    if (!setting.empty()) parameters.Set(setting);
    options.calibration = Path("camera.yaml");
    return simulation::MakeRun(options);
  }

  /// Expects this exit code, `part` in the message and no file in result.
  void ExpectRefusal(const std::string& words, int code, const std::string& part, const std::string& before = "") {
    EXPECT_EQ(Refusal(words + " --out " + Quote(folder / "result"), before), code) << words << '\n' << err;
    EXPECT_NE(err.find(part), std::string::npos) << part << " in: " << err;
    EXPECT_EQ(CountFiles(folder / "result"), 0) << words;
  }

  /// Checksums of all files by their name relative to `result`, without the manifest, which holds times.
  std::map<std::string, std::string> Checksums(const std::string& result) const {
    std::map<std::string, std::string> sums;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / result)) {
      const std::string name = std::filesystem::relative(entry.path(), folder / result).string();
      if (entry.is_regular_file() && name != "manifest.json") sums[name] = io::Sha256(entry.path());
    }
    return sums;
  }

  void ExpectSameBytesForAnyThreads(const std::string& words) {
    ASSERT_EQ(Run(words + "--threads 1 --force"), 0) << err;
    const auto one = Checksums("result");
    for (const char* threads : {"2", "3"}) {
      ASSERT_EQ(Run(words + "--force --threads " + threads), 0) << err;
      EXPECT_EQ(Checksums("result"), one) << threads;
    }
    EXPECT_GE(one.size(), 3u);
  }
};

}  // namespace evo::app
