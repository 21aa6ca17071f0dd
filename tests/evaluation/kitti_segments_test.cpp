#include "evaluation/trajectory/kitti_segments.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "evaluation/reference.hpp"
#include "evo/core/error.hpp"

namespace evo::evaluation {
namespace {

constexpr double kTolerance = 1e-9;

/// Lines of 12 numbers, a 3x4 matrix T_world_cam by rows.
std::vector<geometry::SE3> ReadKittiPoses(const std::string& name) {
  std::ifstream file(ReferencePath(name));
  std::vector<geometry::SE3> poses;
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> T;
  while (true) {
    for (int i = 0; i < 12; ++i) file >> T.data()[i];
    if (!file) return poses;
    poses.emplace_back(Eigen::Quaterniond(Eigen::Matrix3d(T.leftCols<3>())), T.col(3));
  }
}

MatchedTrajectory ReadKittiPath() {
  const auto truth = ReadKittiPoses("kitti_gt.txt");
  const auto estimate = ReadKittiPoses("kitti_est.txt");
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    pairs.push_back({static_cast<TimeNs>(i), static_cast<TimeNs>(i), estimate.at(i), truth.at(i)});
  }
  return BuildMatchedTrajectory(pairs, {});
}

/// `n` poses 1 m apart along x; the estimate is `scale` times as long and turns by `turn` rad a pose about z.
std::vector<PosePair> StraightLine(int n, double scale, double turn) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < n; ++i) {
    const geometry::SE3 truth(Eigen::Quaterniond::Identity(), Eigen::Vector3d(i, 0, 0));
    const geometry::SE3 estimate(geometry::so3::Exp(Eigen::Vector3d(0, 0, turn * i)), Eigen::Vector3d(scale * i, 0, 0));
    pairs.push_back({i * kNsPerSecond, i * kNsPerSecond, estimate, truth});
  }
  return pairs;
}

const std::vector<double> kDefaultLengths = {100, 200, 300, 400, 500, 600, 700, 800};

TEST(KittiSegments, MatchTheDevelopmentKitInDoublePrecision) {
  const auto segments = ComputeKittiSegments(ReadKittiPath(), kDefaultLengths, 10);
  std::ifstream reference(ReferencePath("kitti_double.txt"));
  std::string word;
  std::int64_t count = 0;
  double translation = 0.0;
  double rotation = 0.0;
  reference >> word >> count >> word >> translation >> word >> rotation;
  EXPECT_EQ(segments.translation_percent.count, count);
  EXPECT_NEAR(segments.translation_percent.mean, translation, kTolerance);
  EXPECT_NEAR(segments.rotation_deg_per_m.mean, rotation, kTolerance);
  double length = 0.0;
  std::size_t rows = 0;
  while (reference >> word >> length >> word >> count >> word >> translation >> word >> rotation) {
    const auto& result = segments.lengths.at(rows++);
    EXPECT_EQ(result.length_m, length);
    EXPECT_EQ(result.translation_percent.count, count);
    EXPECT_NEAR(result.translation_percent.mean, translation, kTolerance);
    EXPECT_NEAR(result.rotation_deg_per_m.count, count, kTolerance);
    EXPECT_NEAR(result.rotation_deg_per_m.mean, rotation, kTolerance);
  }
  EXPECT_EQ(rows, 8U);
  EXPECT_EQ(segments.lengths.size(), 8U);
}

// kiss-icp computes in single precision and takes pi for 3.14: its translation agrees to its digits of precision, its
// rotation once that is undone.
TEST(KittiSegments, MatchKissIcpToSinglePrecision) {
  const auto segments = ComputeKittiSegments(ReadKittiPath(), kDefaultLengths, 10);
  std::ifstream reference(ReferencePath("kiss_icp.txt"));
  std::string word;
  double translation = 0.0;
  double rotation = 0.0;
  reference >> word >> translation >> word >> rotation;
  EXPECT_NEAR(segments.translation_percent.mean, translation, 3e-8);
  EXPECT_NEAR(segments.rotation_deg_per_m.mean, rotation * 3.14 / std::numbers::pi, 1e-10);
}

TEST(KittiSegments, AreExactOnAStraightLine) {
  const auto path = BuildMatchedTrajectory(StraightLine(101, 1.1, 0.001), {});
  const auto segments = ComputeKittiSegments(path, std::vector{20.0, 1000.0}, 10);
  ASSERT_EQ(segments.lengths.size(), 1U);  // none of 1000 m fits
  // The end is the first pose farther than 20 m: 21 m on. Starts at 0, 10, ..., 70.
  const auto& result = segments.lengths.front();
  EXPECT_EQ(result.translation_percent.count, 8);
  EXPECT_NEAR(result.rotation_deg_per_m.max, 0.021 * 180.0 / std::numbers::pi / 20.0, 1e-12);
  EXPECT_NEAR(result.rotation_deg_per_m.min, result.rotation_deg_per_m.max, 1e-12);
  // Seen from a camera that has turned by a, the estimate has gone 23.1 m under the angle a off the true 21 m.
  const auto error = [](double a) { return std::hypot(23.1 * std::cos(a) - 21.0, 23.1 * std::sin(a)); };
  EXPECT_NEAR(result.translation_percent.min, 100.0 * error(0.0) / 20.0, 1e-9);
  EXPECT_NEAR(result.translation_percent.max, 100.0 * error(0.07) / 20.0, 1e-9);
}

TEST(KittiSegments, AreEmptyIfNoLengthFits) {
  const auto segments =
      ComputeKittiSegments(BuildMatchedTrajectory(StraightLine(9, 1.0, 0.0), {}), kDefaultLengths, 10);
  EXPECT_TRUE(segments.lengths.empty());
  EXPECT_EQ(segments.translation_percent.count, 0);
  EXPECT_TRUE(std::isnan(segments.translation_percent.mean));
  EXPECT_TRUE(std::isnan(segments.rotation_deg_per_m.mean));
}

TEST(KittiSegments, IgnoreRigidMotionsButNotScale) {
  const auto pairs = StraightLine(101, 1.1, 0.001);
  const std::vector<double> lengths = {20.0};
  const Similarity motion{1.0, geometry::SE3(geometry::so3::Exp({0.3, -2.0, 0.5}), Eigen::Vector3d(5, 6, 7))};
  const auto plain = ComputeKittiSegments(BuildMatchedTrajectory(pairs, {}), lengths, 1);
  const auto moved = ComputeKittiSegments(BuildMatchedTrajectory(pairs, motion), lengths, 1);
  EXPECT_NEAR(moved.translation_percent.rmse, plain.translation_percent.rmse, 1e-10);
  EXPECT_NEAR(moved.rotation_deg_per_m.rmse, plain.rotation_deg_per_m.rmse, 1e-12);
  const auto scaled = ComputeKittiSegments(
      BuildMatchedTrajectory(StraightLine(101, 1.1, 0.0), {1.0 / 1.1, geometry::SE3()}), lengths, 1);
  EXPECT_NEAR(scaled.translation_percent.max, 0.0, 1e-10);
}

// Stops and uneven steps: the ends must be those of a search from the start, as the kit makes it.
TEST(KittiSegments, AgreeWithALinearSearch) {
  std::mt19937 random(7);
  std::vector<PosePair> pairs;
  double x = 0.0;
  for (int i = 0; i < 400; ++i) {
    x += random() % 3 == 0 ? 0.0 : static_cast<double>(random() % 5);
    pairs.push_back({i, i, geometry::SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0.01 * i, 0)),
                     geometry::SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0, 0))});
  }
  for (const double length : {1.0, 7.0, 50.0}) {
    double sum = 0.0;
    std::int64_t count = 0;
    for (std::size_t first = 0; first < pairs.size(); first += 3) {
      for (std::size_t last = first; last < pairs.size(); ++last) {
        const double travelled =
            (pairs[last].T_world_cam_truth.translation() - pairs[first].T_world_cam_truth.translation()).x();
        if (travelled <= length) continue;
        sum += 100.0 * 0.01 * static_cast<double>(last - first) / length;
        ++count;
        break;
      }
    }
    const auto segments = ComputeKittiSegments(BuildMatchedTrajectory(pairs, {}), std::vector{length}, 3);
    EXPECT_EQ(segments.translation_percent.count, count);
    EXPECT_NEAR(segments.translation_percent.mean, sum / static_cast<double>(count), 1e-9);
  }
}

TEST(Lengths, AreMetresOrPercentOfThePath) {
  EXPECT_EQ(ParseLengths("100,50m,10%", 30.0), (std::vector{100.0, 50.0, 3.0}));
  EXPECT_EQ(ParseLengths("5,10%", 0.0), std::vector{5.0});
  EXPECT_EQ(ParseLengths("5,5m,10%", 50.0), std::vector{5.0});  // else its segments would count several times
  for (const std::string bad : {"", "0", "-5", "10 m", "ten", "10,,20", "5km", "nan", "inf", "1e999", "10%%"}) {
    try {
      ParseLengths(bad, 30.0);
      FAIL() << "accepted '" << bad << "'";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kConfiguration);
    }
  }
}

}  // namespace
}  // namespace evo::evaluation
