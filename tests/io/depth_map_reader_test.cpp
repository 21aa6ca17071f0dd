#include "evo/io/depth_map_reader.hpp"

#include <cmath>
#include <limits>

#include "evo/io/mvsec_writer.hpp"
#include "io/hdf5_support.hpp"
#include "io/support.hpp"

namespace evo::io {
namespace {

constexpr char kMaps[] = "davis/left/depth_image_raw";
constexpr char kMoving[] = "davis/left/moving_image_raw";
constexpr char kStamps[] = "davis/left/depth_image_raw_ts";
constexpr TimeNs kStart = 1506117912'000000000;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

class DepthMapsTest : public IoTest {
 protected:
  /// Two maps of 3 x 2 px.
  std::filesystem::path Store(const std::vector<double>& stamps, std::vector<double> depths = {}) const {
    const auto path = folder / "gt.hdf5";
    std::filesystem::remove(path);
    if (depths.empty()) depths.assign(12, 4.0);
    StoreTable(path, kMaps, {depths.size() / 6, 2, 3}, depths, {H5T_NATIVE_FLOAT, {}});
    StoreTable(path, kStamps, {stamps.size()}, stamps);
    return path;
  }

  static std::string RefusalOf(const std::filesystem::path& path) {
    return Refusal([&] { DepthMapReader{path}; });
  }
};

TEST_F(DepthMapsTest, ReadsWhatItWrites) {
  const auto path = folder / "a_gt.hdf5";
  const geometry::Trajectory poses{{kStart, geometry::SE3()}};
  MvsecGroundTruthWriter writer(path, poses, poses);
  writer.AppendDepth(kStart, {3, 2, {1.5, 2.5, 3.5, 4.5, kUnknown, 0.0}});
  writer.AppendDepth(kStart + 50'000'000, {3, 2, {7, 8, 9, 10, 11, 0.1}});
  writer.Commit();

  EXPECT_TRUE(HasDepthMaps(path));
  const DepthMapReader reader(path);
  EXPECT_EQ(reader.width(), 3);
  EXPECT_EQ(reader.height(), 2);
  ASSERT_EQ(reader.stamps().size(), 2u);
  EXPECT_LE(std::abs(reader.stamps()[1] - kStart - 50'000'000), 120);
  const events::DepthMap second = reader.Read(1);
  EXPECT_EQ(second.At(0, 0), 7.0);
  EXPECT_EQ(second.At(1, 1), 11.0);
  EXPECT_EQ(second.At(2, 1), static_cast<double>(0.1F));
  const events::DepthMap first = reader.Read(0);
  EXPECT_EQ(first.At(0, 1), 4.5);
  EXPECT_TRUE(std::isnan(first.At(1, 1)));
  EXPECT_EQ(first.At(2, 1), 0.0);
}

TEST_F(DepthMapsTest, ReadsOptionalMasksOfMovingPixels) {
  const auto path = folder / "a_gt.hdf5";
  MvsecGroundTruthWriter writer(path, {{kStart, geometry::SE3()}}, {{kStart, geometry::SE3()}});
  writer.AppendDepth(kStart, {3, 2, {1, 2, 3, 4, 5, 6}, {0, 1, 0, 0, 0, 1}});
  writer.Commit();
  const events::DepthMap map = DepthMapReader(path).Read(0);
  EXPECT_EQ(map.moving, (std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1}));
  EXPECT_TRUE(map.IsMoving(1, 0) && map.IsMoving(2, 1));
  EXPECT_FALSE(map.IsMoving(0, 0) || map.IsMoving(1, 1));
  const events::DepthMap silent = DepthMapReader(Store({1.0, 2.0})).Read(0);
  EXPECT_TRUE(silent.moving.empty());
  EXPECT_FALSE(silent.IsMoving(1, 0));
}

TEST_F(DepthMapsTest, RefusesFaultyMasksOfMovingPixels) {
  auto path = Store({1.0, 2.0});
  StoreTable(path, kMoving, {2, 3, 2}, std::vector<double>(12, 0.0));
  ExpectMentions(RefusalOf(path), {kMoving, "shape", kMaps});
  path = Store({1.0, 2.0});
  std::vector<double> moving(12, 1.0);
  moving[7] = 0.5;
  StoreTable(path, kMoving, {2, 2, 3}, moving);
  const DepthMapReader reader(path);
  EXPECT_TRUE(reader.Read(0).IsMoving(0, 0));
  ExpectMentions(Refusal([&] { reader.Read(1); }), {"gt.hdf5", kMoving, "row 1", "0.5"});
}

TEST_F(DepthMapsTest, NothingAppearsBeforeCommit) {
  const auto path = folder / "gt.hdf5";
  {
    MvsecGroundTruthWriter writer(path, {{kStart, geometry::SE3()}}, {{kStart, geometry::SE3()}});
    writer.AppendDepth(kStart, {1, 1, {1.0}});
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST_F(DepthMapsTest, DetectsDepthMaps) {
  const auto path = folder / "gt.hdf5";
  WriteMvsecGroundTruth(path, {{kStart, geometry::SE3()}}, {{kStart, geometry::SE3()}});
  EXPECT_FALSE(HasDepthMaps(path));
  EXPECT_FALSE(HasDepthMaps(Write("groundtruth.txt", "1 0 0 0 0 0 0 1\n")));
  ExpectMentions(RefusalOf(path), {"gt.hdf5", kMaps, "davis/left/odometry"});
  ExpectMentions(RefusalOf(folder / "groundtruth.txt"), {"groundtruth.txt", "depth maps"});
  Refusal([&] { HasDepthMaps(folder / "missing"); });
}

TEST_F(DepthMapsTest, NamesRectifiedMapsInPlaceOfRawOnes) {
  const auto path = folder / "gt.hdf5";
  StoreTable(path, "davis/left/depth_image_rect", {1, 1, 1}, {1.0});
  ExpectMentions(RefusalOf(path), {kMaps, "depth_image_rect", "rectified"});
}

TEST_F(DepthMapsTest, RefusesFaultyStamps) {
  EXPECT_EQ(DepthMapReader(Store({1.0, 2.0})).stamps()[1], 2 * kNsPerSecond);
  ExpectMentions(RefusalOf(Store({1.0})), {kStamps, "2 depth maps"});
  ExpectMentions(RefusalOf(Store({2.0, 1.0})), {kStamps, "row 1", "not later"});
  ExpectMentions(RefusalOf(Store({1.0, kUnknown})), {kStamps, "row 1", "not a time"});
}

TEST_F(DepthMapsTest, RefusesImpossibleMaps) {
  const auto path = folder / "gt.hdf5";
  StoreTable(path, kMaps, {2, 6}, std::vector<double>(12, 4.0));
  StoreTable(path, kStamps, {2}, {1.0, 2.0});
  ExpectMentions(RefusalOf(path), {kMaps, "N x height x width"});
  std::filesystem::remove(path);
  StoreTable(path, kMaps, {0, 2, 3}, {});
  StoreTable(path, kStamps, {0}, {});
  ExpectMentions(RefusalOf(path), {kMaps, "no depth maps"});
  std::vector<double> depths(12, 4.0);
  depths[8] = -1.5;
  const DepthMapReader reader(Store({1.0, 2.0}, depths));
  EXPECT_EQ(reader.Read(0).At(0, 0), 4.0);
  ExpectMentions(Refusal([&] { reader.Read(1); }), {"gt.hdf5", kMaps, "row 1", "-1.5"});
}

TEST_F(DepthMapsTest, RefusesATruncatedFile) {
  const auto path = Store({1.0, 2.0});
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  ExpectMentions(RefusalOf(path), {"gt.hdf5"});
}

}  // namespace
}  // namespace evo::io
