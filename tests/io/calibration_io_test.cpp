#include "evo/io/calibration_io.hpp"

#include <gtest/gtest.h>

#include <string>

#include "io/support.hpp"

namespace evo::io {
namespace {

const std::string kCamchain =
    "T_cam0_lidar:\n"
    "- [1.0, 0.0, 0.0, 0.0]\n"
    "cam0:\n"
    "  camera_model: pinhole\n"
    "  intrinsics: [226.38018519795807, 226.15002947047415, 173.6470807871759, 133.73271487507847]\n"
    "  distortion_model: equidistant\n"
    "  distortion_coeffs: [-0.048031442223833355, 0.011330957517194437, -0.055378166304281135, 0.021500973881459395]\n"
    "  resolution: [346, 260]\n"
    "cam1:\n"
    "  camera_model: omni\n";

const std::string kUzh = "199.092366542 198.82882047 132.192071378 110.712660011 -0.368 0.15 -0.0003 -0.0008 0.01\n";

class CalibrationIoTest : public IoTest {
 protected:
  /// The refusal of the camchain with `from` replaced by `to`.
  std::string RefusalWith(const std::string& from, const std::string& to) const {
    std::string text = kCamchain;
    text.replace(text.find(from), from.size(), to);
    return RefusalOf(text);
  }
  std::string RefusalOf(const std::string& text) const {
    const auto path = Write("bad.yaml", text);
    return Refusal([&] { ReadCalibration(path); });
  }
};

TEST_F(CalibrationIoTest, ReadsTheFirstCameraOfACamchain) {
  const geometry::Calibration c = ReadCalibration(Write("camchain.yaml", kCamchain));
  EXPECT_EQ(c.distortion, geometry::Distortion::kEquidistant);
  EXPECT_EQ(c.width, 346);
  EXPECT_EQ(c.height, 260);
  EXPECT_EQ(c.fx, 226.38018519795807);
  EXPECT_EQ(c.fy, 226.15002947047415);
  EXPECT_EQ(c.cx, 173.6470807871759);
  EXPECT_EQ(c.cy, 133.73271487507847);
  const std::array<double, 5> k = {-0.048031442223833355, 0.011330957517194437, -0.055378166304281135,
                                   0.021500973881459395, 0.0};
  EXPECT_EQ(c.coefficients, k);
}

TEST_F(CalibrationIoTest, ReadsRadtanCamchains) {
  std::string text = kCamchain;
  text.replace(text.find("equidistant"), 11, "radtan");
  EXPECT_EQ(ReadCalibration(Write("camchain.yaml", text)).distortion, geometry::Distortion::kRadTan);
}

TEST_F(CalibrationIoTest, ReadsUzhWithTheDefaultOrGivenSensor) {
  const auto path = Write("calib.txt", kUzh);
  const geometry::Calibration c = ReadCalibration(path);
  EXPECT_EQ(c.distortion, geometry::Distortion::kRadTan);
  EXPECT_EQ(c.width, 240);
  EXPECT_EQ(c.height, 180);
  EXPECT_EQ(c.fx, 199.092366542);
  EXPECT_EQ(c.cy, 110.712660011);
  EXPECT_EQ(c.coefficients, (std::array<double, 5>{-0.368, 0.15, -0.0003, -0.0008, 0.01}));
  EXPECT_EQ(ReadCalibration(path, ImageSize{346, 260}).width, 346);
}

TEST_F(CalibrationIoTest, SizeMustAgreeWithTheCamchain) {
  const auto path = Write("camchain.yaml", kCamchain);
  EXPECT_EQ(ReadCalibration(path, ImageSize{346, 260}).height, 260);
  ExpectMentions(Refusal([&] {
                   ReadCalibration(path, ImageSize{240, 180});
                 }),
                 {"camchain.yaml:8", "cam0.resolution", "346 x 260", "240 x 180"});
}

TEST_F(CalibrationIoTest, RefusesAFaultyCamchainAndNamesLineAndKey) {
  ExpectMentions(RefusalWith("226.38018519795807", ".nan"), {"bad.yaml:5", "cam0.intrinsics", "'.nan'"});
  ExpectMentions(RefusalWith("226.15002947047415", "-226"), {"bad.yaml:5", "cam0.intrinsics", "-226", "positive"});
  ExpectMentions(RefusalWith("226.15002947047415", "0"), {"positive"});
  ExpectMentions(RefusalWith("173.6470807871759", "373"), {"bad.yaml:5", "principal point", "346 x 260"});
  ExpectMentions(RefusalWith(", 133.73271487507847", ""), {"bad.yaml:5", "cam0.intrinsics", "4 numbers"});
  ExpectMentions(RefusalWith("-0.048031442223833355", "x"), {"bad.yaml:7", "cam0.distortion_coeffs", "'x'"});
  ExpectMentions(RefusalWith("-0.048031442223833355", "[1]"), {"bad.yaml:7", "cam0.distortion_coeffs"});
  ExpectMentions(RefusalWith("equidistant", "fov"), {"bad.yaml:6", "'fov'", "equidistant and radtan"});
  ExpectMentions(RefusalWith("pinhole", "omni"), {"bad.yaml:4", "'omni'", "pinhole"});
  ExpectMentions(RefusalWith("pinhole", "[pinhole]"), {"bad.yaml:4", "cam0.camera_model"});
  ExpectMentions(RefusalWith("[346, 260]", "[346.5, 260]"), {"bad.yaml:8", "cam0.resolution", "346.5"});
  ExpectMentions(RefusalWith("[346, 260]", "[0, 260]"), {"bad.yaml:8", "cam0.resolution"});
  ExpectMentions(RefusalWith("  resolution: [346, 260]\n", ""), {"bad.yaml:4", "no 'resolution'"});
  ExpectMentions(RefusalWith("[346, 260]", "[346, 260"), {"bad.yaml:", "not valid YAML"});
  ExpectMentions(RefusalOf("cam0: 3\n"), {"no camera 'cam0'"});
  ExpectMentions(RefusalOf("cam1:\n  camera_model: pinhole\n"), {"bad.yaml:1", "camchain"});
}

TEST_F(CalibrationIoTest, RefusesAFaultyCalibTxt) {
  ExpectMentions(RefusalOf("199 198 132 110 0 0 0 0 0 0\n"), {"bad.yaml:1", "nine numbers"});
  ExpectMentions(RefusalOf("# calib\n199 nan 132 110 0 0 0 0 0\n"), {"bad.yaml:2", "'nan'"});
  ExpectMentions(RefusalOf("0 198 132 110 0 0 0 0 0\n"), {"bad.yaml:1", "positive"});
  ExpectMentions(RefusalOf("199 198 132 180 0 0 0 0 0\n"), {"bad.yaml:1", "principal point", "240 x 180"});
  ExpectMentions(RefusalOf(kUzh + kUzh), {"bad.yaml:2"});
}

TEST_F(CalibrationIoTest, RefusesOtherFiles) {
  ExpectMentions(RefusalOf(""), {"an empty file"});
  ExpectMentions(RefusalOf("0.1 1 1 1\n"), {"an event text", "calib.txt"});
  ExpectMentions(RefusalOf("\x89PNG\r\n\x1a\n"), {"a PNG image"});
  ExpectMentions(Refusal([&] { ReadCalibration(folder); }), {"a folder"});
  ExpectMentions(Refusal([&] { ReadCalibration(folder / "none.txt"); }), {"none.txt", "no such file"});
}

/// As a lone camera is rectified: not turned, by its own intrinsics.
TEST_F(CalibrationIoTest, CamchainHoldsTheRectification) {
  geometry::Calibration c{geometry::Distortion::kEquidistant, 30, 20, 11.5, 12.5, 14.0, 9.0, {0.1, 0.2, 0.3, 0.4, 0.0}};
  WriteCamchain(folder / "camchain.yaml", c);
  std::ifstream file(folder / "camchain.yaml");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find("  projection_matrix:\n  - [11.5, 0, 14, 0]\n  - [0, 12.5, 9, 0]\n  - [0, 0, 1, 0]\n"),
            std::string::npos);
  EXPECT_NE(text.find("  rectification_matrix:\n  - [1, 0, 0]\n  - [0, 1, 0]\n  - [0, 0, 1]\n"), std::string::npos);
  EXPECT_EQ(ReadCalibration(folder / "camchain.yaml").coefficients, c.coefficients);
}

}  // namespace
}  // namespace evo::io
