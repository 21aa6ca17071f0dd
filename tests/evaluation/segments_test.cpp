#include "evaluation/trajectory/segments.hpp"

#include <gtest/gtest.h>

#include "evo/core/error.hpp"
#include "evo/core/parameters.hpp"

namespace evo::evaluation {
namespace {

TEST(SegmentOptions, SurviveARoundTripThroughYaml) {
  EvaluationOptions all;
  SegmentOptions& options = all.segments;
  Parameters parameters;
  Register(parameters, all);
  options.subtrajectory_lengths = "10m,50%";
  const std::string yaml = parameters.ToYaml();
  options = {};
  parameters.LoadText(yaml, "printed.yaml");
  EXPECT_EQ(options.subtrajectory_lengths, "10m,50%");
  EXPECT_EQ(options.kitti_lengths_m, SegmentOptions().kitti_lengths_m);
}

TEST(SegmentOptions, InvalidLengthsNameTheirLine) {
  EvaluationOptions all;
  SegmentOptions& options = all.segments;
  Parameters parameters;
  Register(parameters, all);
  try {
    parameters.LoadText("evaluation:\n  kitti_lengths_m: 100,far\n", "mine.yaml");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kConfiguration);
    EXPECT_TRUE(std::string(error.what()).starts_with("mine.yaml:2: ")) << error.what();
  }
  EXPECT_EQ(options.kitti_lengths_m, SegmentOptions().kitti_lengths_m);
}

TEST(Segments, PercentagesReferToThePath) {
  std::vector<PosePair> pairs;
  for (int i = 0; i <= 100; ++i) {
    const geometry::SE3 pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.1 * i, 0, 0));
    pairs.push_back({i * kNsPerSecond / 10, i * kNsPerSecond / 10, pose, pose});
  }
  SegmentOptions options;
  options.kitti_lengths_m = "20%,90%";
  const auto result =
      EvaluateSegments(BuildMatchedTrajectory(pairs), Eigen::Vector3d::UnitZ(), 0, kNsPerSecond, options);
  ASSERT_EQ(result.kitti.lengths.size(), 2U);
  EXPECT_NEAR(result.kitti.lengths[1].length_m, 9.0, 1e-9);
  ASSERT_EQ(result.sub_trajectories.size(), 5U);
  EXPECT_NEAR(result.sub_trajectories[4].length_m, 5.0, 1e-9);
  EXPECT_EQ(result.local_scale.size(), pairs.size());
}

}  // namespace
}  // namespace evo::evaluation
