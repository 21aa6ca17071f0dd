#include "evo/io/trajectory_io.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "evo/io/file_kind.hpp"
#include "evo/io/mvsec_writer.hpp"
#include "io/hdf5_support.hpp"
#include "io/support.hpp"

namespace evo::io {
namespace {

geometry::Trajectory MakeTrajectory(int count, TimeNs first) {
  geometry::Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    geometry::Vector6d xi;
    xi << 0.3 * i, std::sin(0.1 * i), 100.0 * std::cos(0.2 * i), 0.05 * i, 0.4, -0.02 * i;
    trajectory.push_back({first + i * TimeNs{50'000'000}, geometry::SE3::Exp(xi)});
  }
  return trajectory;
}

void ExpectNear(const geometry::Trajectory& a, const geometry::Trajectory& b, TimeNs stamp_tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LE(std::abs(a[i].t - b[i].t), stamp_tolerance);
    EXPECT_LT((a[i].T_world_cam.Matrix() - b[i].T_world_cam.Matrix()).cwiseAbs().maxCoeff(), 1e-11);
  }
}

class TrajectoryIoTest : public IoTest {
 protected:
  std::string RefusalOf(const std::string& text) const {
    const auto path = Write("bad.txt", text);
    return Refusal([&] { ReadTum(path); });
  }
  /// Of an MVSEC ground truth with three still poses, one number of which is `value`.
  std::string MvsecRefusal(const std::vector<double>& stamps, std::size_t index = 0, double value = 1.0) const {
    const auto path = folder / "bad_gt.hdf5";
    std::filesystem::remove(path);
    std::vector<double> poses;
    for (int i = 0; i < 3; ++i) poses.insert(poses.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    poses[index] = value;
    StoreTable(path, "davis/left/odometry", {3, 4, 4}, poses);
    StoreTable(path, "davis/left/odometry_ts", {stamps.size()}, stamps);
    return Refusal([&] { ReadGroundTruth(path, GroundTruthSource::kLoam); });
  }
};

TEST_F(TrajectoryIoTest, ReadsWhatItWrites) {
  const geometry::Trajectory trajectory = MakeTrajectory(50, 1506117912'000000123);
  WriteTum(folder / "out" / "a.txt", trajectory);
  ExpectNear(ReadTum(folder / "out" / "a.txt"), trajectory, 0);
  ExpectNear(ReadGroundTruth(folder / "out" / "a.txt", GroundTruthSource::kCartographer), trajectory, 0);
  WriteTum(folder / "b.txt", trajectory);
  EXPECT_EQ(Content(folder / "out" / "a.txt"), Content(folder / "b.txt"));
}

TEST_F(TrajectoryIoTest, WritesStrictTum) {
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  WriteTum(folder / "a.txt", {{1'500'000'000, {rotation, {1, -2, 0.1}}}});
  EXPECT_EQ(Content(folder / "a.txt"),
            "1.500000000 1.000000000000 -2.000000000000 0.100000000000 0.000000000000 0.000000000000 "
            "0.707106781187 0.707106781187\n");
}

TEST_F(TrajectoryIoTest, RefusesToWriteWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ExpectMentions(Refusal([&] {
                   WriteTum(folder / "a.txt", {{kNsPerSecond, {Eigen::Quaterniond::Identity(), {0, nan, 0}}}});
                 }),
                 {"a.txt", "1.000000000 s"});
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST_F(TrajectoryIoTest, ReadsBothTrajectoriesOfMvsec) {
  const auto path = folder / "a_gt.hdf5";
  const geometry::Trajectory odometry = MakeTrajectory(30, 1506117912'000000000);
  const geometry::Trajectory pose = MakeTrajectory(20, 1506117913'000000000);
  WriteMvsecGroundTruth(path, odometry, pose);
  ExpectNear(ReadGroundTruth(path, GroundTruthSource::kLoam), odometry, 120);
  ExpectNear(ReadGroundTruth(path, GroundTruthSource::kCartographer), pose, 120);
}

TEST_F(TrajectoryIoTest, ReadsRowMajorMatrices) {
  const auto path = folder / "a_gt.hdf5";
  StoreTable(path, "davis/left/pose", {1, 4, 4}, {0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1});
  StoreTable(path, "davis/left/pose_ts", {1}, {2.5});
  const geometry::Trajectory read = ReadGroundTruth(path, GroundTruthSource::kCartographer);
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].t, 2'500'000'000);
  EXPECT_LT((read[0].T_world_cam * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(5, 7, 7)).norm(), 1e-12);
  ExpectMentions(Refusal([&] { ReadGroundTruth(path, GroundTruthSource::kLoam); }),
                 {"no data set davis/left/odometry", "davis/left/pose, davis/left/pose_ts"});
}

TEST_F(TrajectoryIoTest, RefusesFaultyMvsecGroundTruth) {
  ExpectMentions(MvsecRefusal({1, 2}), {"davis/left/odometry_ts", "3 poses"});
  ExpectMentions(MvsecRefusal({1, 2, 2}), {"odometry_ts row 2", "2.000000000 s", "sort"});
  ExpectMentions(MvsecRefusal({1, 3, 2}), {"odometry_ts row 2", "3.000000000 s"});
  ExpectMentions(MvsecRefusal({1, std::nan(""), 2}), {"odometry_ts row 1", "nan"});
  ExpectMentions(MvsecRefusal({1, 2, 3}, 16, 0.5), {"davis/left/odometry row 1", "orthonormal"});
  ExpectMentions(MvsecRefusal({1, 2, 3}, 16, -1.0), {"davis/left/odometry row 1", "orthonormal"});
  ExpectMentions(MvsecRefusal({1, 2, 3}, 35, std::nan("")), {"davis/left/odometry row 2", "not finite"});
  ExpectMentions(MvsecRefusal({1, 2, 3}, 15, 0.0), {"davis/left/odometry row 0", "last row"});
}

TEST_F(TrajectoryIoTest, RefusesFaultyTextAndNamesTheLine) {
  const std::string good = "# t px py pz qx qy qz qw\n1.0 0 0 0 0 0 0 1\n";
  ExpectMentions(RefusalOf(good + "2.0 0 0 0 0 0 0\n"), {"bad.txt:3: ", "qw"});
  ExpectMentions(RefusalOf(good + "2.0 0 0 nan 0 0 0 1\n"), {"bad.txt:3: ", "'nan'"});
  ExpectMentions(RefusalOf(good + "2.0 0 0 -1e160 0 0 0 1\n"), {"bad.txt:3: ", "1e12 m"});
  ExpectMentions(RefusalOf(good + "2.0 0 0 0 0 0 0 x\n"), {"bad.txt:3: ", "'x'"});
  ExpectMentions(RefusalOf(good + "2.0 0 0 0 0 0 0 0.9\n"), {"bad.txt:3: ", "0.9"});
  ExpectMentions(RefusalOf(good + "2.0 0 0 0 0 0 0 0\n"), {"bad.txt:3: ", "norm"});
  ExpectMentions(RefusalOf(good + "then 0 0 0 0 0 0 1\n"), {"bad.txt:3: ", "'then'"});
  ExpectMentions(RefusalOf(good + "1.0 0 0 0 0 0 0 1\n"), {"bad.txt:3: ", "not later", "1.000000000 s"});
  ExpectMentions(RefusalOf(good + "0.5 0 0 0 0 0 0 1\n"), {"bad.txt:3: ", "0.500000000 s"});
  ExpectMentions(RefusalOf("# nothing\n"), {"no poses"});
}

TEST_F(TrajectoryIoTest, ReadsKittiPosesRowByRow) {
  const auto path = Write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 5 1 0 0 6 0 0 1 7\n");
  EXPECT_EQ(DetectKind(path), FileKind::kKittiPoses);
  const geometry::Trajectory read = ReadKitti(path);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[1].t, kNsPerSecond);
  EXPECT_LT((read[1].T_world_cam * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(5, 7, 7)).norm(), 1e-12);
}

TEST_F(TrajectoryIoTest, RefusesFaultyKittiPosesAndNamesTheLine) {
  const std::string good = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  const auto refusal = [&](const std::string& text) {
    const auto path = Write("bad.txt", text);
    return Refusal([&] { ReadKitti(path); });
  };
  ExpectMentions(refusal(good + "1 0 0 0 0 1 0 0 0 0 1\n"), {"bad.txt:2: ", "12 numbers", "found 11"});
  ExpectMentions(refusal(good + "1 0 0 nan 0 1 0 0 0 0 1 0\n"), {"bad.txt:2: ", "'nan'"});
  ExpectMentions(refusal(good + "1 0 0 1e160 0 1 0 0 0 0 1 0\n"), {"bad.txt:2: ", "1e12 m"});
  ExpectMentions(refusal(good + "1 0 0 0 0 2 0 0 0 0 1 0\n"), {"bad.txt:2: ", "orthonormal"});
  ExpectMentions(refusal(good + "1 0 0 0 0 1 0 0 0 0 -1 0\n"), {"bad.txt:2: ", "orthonormal"});
  ExpectMentions(refusal("1.0 0 0 0 0 0 0 1\n"), {"a trajectory text", "12 numbers"});
  ExpectMentions(refusal(""), {"an empty file"});
  const auto path = Write("poses.txt", good);
  ExpectMentions(Refusal([&] { ReadTum(path); }), {"a KITTI pose file"});
  ExpectMentions(Refusal([&] { ReadGroundTruth(path, GroundTruthSource::kLoam); }), {"a KITTI pose file"});
}

TEST_F(TrajectoryIoTest, RefusesOtherFiles) {
  ExpectMentions(RefusalOf(""), {"an empty file"});
  ExpectMentions(RefusalOf("0.1 1 1 1\n"), {"an event text", "a trajectory"});
  StoreTable(folder / "a.hdf5", "x", {1}, {1});
  ExpectMentions(Refusal([&] { ReadTum(folder / "a.hdf5"); }), {"an HDF5 file"});
  ExpectMentions(Refusal([&] { ReadTum(folder / "none"); }), {"no such file"});
  ExpectMentions(Refusal([&] { ReadGroundTruth(folder, GroundTruthSource::kLoam); }), {"a folder"});
}

}  // namespace
}  // namespace evo::io
