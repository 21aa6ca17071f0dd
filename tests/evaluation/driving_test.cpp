#include "evo/evaluation/driving.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "evo/core/error.hpp"
#include "evo/evaluation/evaluation.hpp"

namespace evo::evaluation {
namespace {

constexpr TimeNs kStep = 50'000'000;

/// The MVSEC world: x right, y down, z forward; the camera looks along z.
geometry::Trajectory Along(const std::vector<Eigen::Vector3d>& positions) {
  geometry::Trajectory trajectory;
  for (const auto& p : positions) {
    trajectory.push_back({static_cast<TimeNs>(trajectory.size()) * kStep, geometry::SE3({1, 0, 0, 0}, p)});
  }
  return trajectory;
}

geometry::Trajectory StraightAhead(int poses, double step) {
  std::vector<Eigen::Vector3d> positions;
  for (int i = 0; i < poses; ++i) positions.push_back({0, 0, step * i});
  return Along(positions);
}

TEST(UpDirection, FollowsTheCameraInEveryWorld) {
  const auto camera_world = StraightAhead(3, 1.0);
  EXPECT_EQ(UpDirection("auto", camera_world), -Eigen::Vector3d::UnitY());
  geometry::Trajectory surveyed;  // z up, the camera looks along x, tilted by 20 degrees
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Quaterniond tilt = geometry::so3::Exp({20.0 * std::numbers::pi / 180.0, 0, 0});
  surveyed.push_back({0, geometry::SE3(Eigen::Quaterniond(axes) * tilt, Eigen::Vector3d::Zero())});
  EXPECT_EQ(UpDirection("auto", surveyed), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(UpDirection("-x", surveyed), -Eigen::Vector3d::UnitX());
  EXPECT_EQ(UpDirection("y", surveyed), Eigen::Vector3d::UnitY());
}

TEST(DrivingFrame, NamesErrorsAsTheDriverWould) {
  const auto truth = StraightAhead(21, 0.5);
  DrivingFrame frame(truth, UpDirection("auto", truth), "travel", 1.0);
  const geometry::SE3& T_world_cam = truth[10].T_world_cam;
  // Ahead is z, left is -x, up is -y.
  const auto error =
      frame.Split(truth[10].t, T_world_cam, T_world_cam.translation() + Eigen::Vector3d(-0.3, -0.2, 0.4));
  EXPECT_NEAR(error.longitudinal, 0.4, 1e-12);
  EXPECT_NEAR(error.lateral, 0.3, 1e-12);
  EXPECT_NEAR(error.vertical, 0.2, 1e-12);
  EXPECT_NEAR(error.planar, 0.5, 1e-12);
}

TEST(DrivingFrame, DirectionIsThatOfTravelNotOfView) {
  std::vector<Eigen::Vector3d> positions;  // the camera looks along z but slides to the right
  for (int i = 0; i < 20; ++i) positions.push_back({0.3 * i, 0, 0});
  const auto truth = Along(positions);
  DrivingFrame frame(truth, -Eigen::Vector3d::UnitY(), "travel", 1.0);
  const Eigen::Vector3d estimate = positions[7] + Eigen::Vector3d(1, 0, 0);
  EXPECT_NEAR(frame.Split(truth[7].t, truth[7].T_world_cam, estimate).longitudinal, 1.0, 1e-12);
}

TEST(DrivingFrame, HeadingIsHeldThroughATremblingStop) {
  std::vector<Eigen::Vector3d> positions;
  for (int i = 0; i < 10; ++i) positions.push_back({0, 0, 0.5 * i});
  for (int i = 0; i < 100; ++i) positions.push_back({0.01 * std::sin(3.0 * i), 0, 4.5 + 0.01 * std::cos(5.0 * i)});
  const auto truth = Along(positions);
  DrivingFrame frame(truth, -Eigen::Vector3d::UnitY(), "travel", 1.0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const geometry::SE3& T_world_cam = truth[i].T_world_cam;
    const Eigen::Vector3d estimate = T_world_cam.translation() + Eigen::Vector3d(0, 0, 1);
    EXPECT_NEAR(frame.Split(truth[i].t, T_world_cam, estimate).longitudinal, 1.0, 1e-3) << i;
  }
}

TEST(DrivingFrame, StandingStillFallsBackOnTheViewDirection) {
  const auto truth = StraightAhead(5, 0.0);
  DrivingFrame frame(truth, -Eigen::Vector3d::UnitY(), "travel", 1.0);
  const auto error = frame.Split(truth[2].t, truth[2].T_world_cam, {0.2, 0, 1.0});
  EXPECT_NEAR(error.longitudinal, 1.0, 1e-12);
  EXPECT_NEAR(error.lateral, -0.2, 1e-12);
}

TEST(DrivingFrame, LooksDownAndStandsStill) {
  geometry::Trajectory truth{
      {0, geometry::SE3(geometry::so3::Exp({-std::numbers::pi / 2, 0, 0}), Eigen::Vector3d::Zero())}};
  const Eigen::Vector3d up = truth[0].T_world_cam.rotation() * -Eigen::Vector3d::UnitZ();
  DrivingFrame frame(truth, up, "travel", 1.0);
  const auto error = frame.Split(0, truth[0].T_world_cam, {0.3, 0.2, 0.4});
  EXPECT_NEAR(std::hypot(error.longitudinal, error.lateral), error.planar, 1e-12);
  EXPECT_GT(error.planar, 0.0);
}

TEST(DrivingFrame, BodyIsTheCamerasOwnFrame) {
  geometry::Trajectory truth = StraightAhead(5, 0.5);
  const geometry::SE3 pose(geometry::so3::Exp({0.0, 0.5 * std::numbers::pi, 0.0}),
                           {0, 0, 1.0});  // looks along x, right is -z
  DrivingFrame frame(truth, -Eigen::Vector3d::UnitY(), "body", 1.0);
  const auto error = frame.Split(truth[2].t, pose, Eigen::Vector3d(0.3, -0.2, 1.4));
  EXPECT_NEAR(error.longitudinal, 0.3, 1e-12);
  EXPECT_NEAR(error.lateral, 0.4, 1e-12);
  EXPECT_NEAR(error.vertical, 0.2, 1e-12);
  EXPECT_NEAR(error.planar, 0.5, 1e-12);
}

TEST(PositionSearch, FindsWhatAWalkFinds) {
  std::mt19937 random(3);
  std::normal_distribution<double> step(0.0, 0.3);
  for (const std::size_t count : {1u, 2u, 3u, 64u, 257u}) {
    std::vector<Eigen::Vector3d> positions{Eigen::Vector3d::Zero()};
    while (positions.size() < count) {
      const bool stands = positions.size() % 50 > 20;
      positions.push_back(positions.back() +
                          (stands ? Eigen::Vector3d::Zero() : Eigen::Vector3d(step(random), step(random), 0.1)));
    }
    const PositionSearch search(positions);
    for (std::size_t i = 0; i < count; ++i) {  // the far position may be at the very distance
      const double distance = (positions[i] - positions[0]).norm();
      ASSERT_LE(search.FirstFar(0, positions[0], distance).value_or(count), i);
    }
    for (std::size_t from = 0; from < count; ++from) {
      const Eigen::Vector3d center = positions[from] + Eigen::Vector3d(0.01, 0, 0);
      const auto far = [&](std::size_t i) { return (positions[i] - center).norm() >= 1.0; };
      std::optional<std::size_t> first;
      for (std::size_t i = from; i < count && !first; ++i) first = far(i) ? std::optional(i) : std::nullopt;
      std::optional<std::size_t> last;
      for (std::size_t i = from + 1; i > 0 && !last; --i) last = far(i - 1) ? std::optional(i - 1) : std::nullopt;
      ASSERT_EQ(search.FirstFar(from, center, 1.0), first) << count << ' ' << from;
      ASSERT_EQ(search.LastFar(from, center, 1.0), last) << count << ' ' << from;
    }
  }
}

TEST(Evaluation, ErrorOverDistanceLeavesOutTheFirstMetre) {
  const auto truth = StraightAhead(11, 0.4);  // 4 m
  geometry::Trajectory estimate = truth;
  for (auto& pose : estimate) {
    pose.T_world_cam =
        geometry::SE3(pose.T_world_cam.rotation(), pose.T_world_cam.translation() + Eigen::Vector3d(0, 0, 0.1));
  }
  const auto result = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, {}).alignments.front();
  double expected = 0.0;
  for (int i = 3; i <= 10; ++i) expected += 0.1 / (0.4 * i) / 8.0;
  EXPECT_NEAR(result.planar.mean_over_distance, expected, 1e-12);
  EXPECT_NEAR(result.longitudinal.mean_over_distance, expected, 1e-12);
  EXPECT_NEAR(result.lateral.mean_over_distance, 0.0, 1e-12);
  const auto short_way = StraightAhead(3, 0.4);
  EXPECT_TRUE(std::isnan(Evaluate(short_way, short_way, std::vector{ParseAlignment("none")}, {}, {})
                             .alignments.front()
                             .planar.mean_over_distance));
}

TEST(Evaluation, ProjectionConfinesAllErrorsToThePlane) {
  const auto truth = StraightAhead(51, 0.4);
  geometry::Trajectory estimate = truth;
  for (auto& pose : estimate) {
    pose.T_world_cam =
        geometry::SE3(geometry::so3::Exp({0.3, 0.1, 0.2}), pose.T_world_cam.translation() + Eigen::Vector3d(0, 5.0, 0));
  }
  EvaluationOptions options;
  options.project = "xz";
  const auto evaluation = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, options);
  const auto& result = evaluation.alignments.front();
  EXPECT_NEAR(result.Ape(PoseRelation::kTranslation).max, 0.0, 1e-12);
  EXPECT_LT(result.Ape(PoseRelation::kRotationRad).max, 0.2);
  EXPECT_EQ(evaluation.truth.front().T_world_cam.translation().y(), 0.0);
  EXPECT_EQ(result.aligned.front().T_world_cam.translation().y(), 0.0);
}

TEST(Evaluation, LeavesOutWhatIsUndetermined) {
  const auto line = StraightAhead(21, 0.5);
  EvaluationOptions options;
  const auto alignments = ParseAlignments("sim3,origin-scale");
  EXPECT_THROW(Evaluate(line, line, alignments, {}, options), Error);
  options.leave_out_undetermined = true;
  const auto evaluation = Evaluate(line, line, alignments, {}, options);
  ASSERT_EQ(evaluation.alignments.size(), 1u);
  EXPECT_EQ(evaluation.alignments.front().alignment.name, "origin-scale");
  ASSERT_EQ(evaluation.left_out.size(), 1u);
  EXPECT_NE(evaluation.left_out.front().find("sim3"), std::string::npos);
}

TEST(Evaluation, WithoutStampsThereAreNoSeconds) {
  auto truth = StraightAhead(31, 0.5);
  for (std::size_t i = 0; i < truth.size(); ++i) truth[i].t = static_cast<TimeNs>(i) * kNsPerSecond;
  EvaluationOptions options;
  options.association.association = "index";
  const auto evaluation = Evaluate(truth, truth, ParseAlignments("none"), {}, options);
  EXPECT_FALSE(evaluation.has_stamps);
  EXPECT_EQ(evaluation.coverage, 1.0);
  EXPECT_EQ(evaluation.gaps, 0);
  const auto& rpe = evaluation.alignments.front().rpe;
  ASSERT_EQ(rpe.size(), 3u);  // 1f, 1s, 10m
  EXPECT_EQ(rpe[0].relations.front().statistics.count, 30);
  EXPECT_EQ(rpe[1].relations.front().statistics.count, 0);
  EXPECT_EQ(rpe[2].relations.front().statistics.count, 0);  // one crossing in 15 m makes no pair
  options.rpe.required = true;
  options.rpe.deltas = "1s";
  EXPECT_THROW(Evaluate(truth, truth, ParseAlignments("none"), {}, options), Error);
  options.rpe = {};
  EXPECT_THROW(Evaluate(truth, truth, ParseAlignments("sim3:5s"), {}, options), Error);
}

TEST(Evaluation, CountsPathCoverageAndGaps) {
  const auto truth = StraightAhead(201, 0.5);  // 10 s, 100 m
  geometry::Trajectory estimate;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double t = ToSeconds(truth[i].t);
    if (t >= 2.0 && (t <= 5.0 || t >= 6.0)) estimate.push_back(truth[i]);
  }
  const auto evaluation = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, {});
  EXPECT_EQ(evaluation.gaps, 2);  // before 2 s and from 5 s to 6 s
  EXPECT_NEAR(evaluation.coverage, 0.7, 1e-12);
  EXPECT_NEAR(evaluation.path_m, 80.0, 1e-9);
  const auto& errors = evaluation.alignments.front().errors;
  EXPECT_NEAR(errors.back().distance, 80.0, 1e-9);
  EXPECT_NEAR(errors.front().seconds, 2.0, 1e-12);

  const EvaluationInterval interval{4 * kNsPerSecond, 8 * kNsPerSecond};
  const auto part = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, interval, {});
  EXPECT_EQ(part.gaps, 1);
  EXPECT_NEAR(part.coverage, 0.75, 1e-12);
  EXPECT_NEAR(part.path_m, 40.0, 1e-9);
}

TEST(Evaluation, SignedErrorsAndTheirSummary) {
  const auto truth = StraightAhead(101, 0.5);
  geometry::Trajectory estimate = truth;
  for (auto& pose : estimate) {
    const Eigen::Vector3d p = pose.T_world_cam.translation();
    pose.T_world_cam = geometry::SE3(pose.T_world_cam.rotation(), {0.01 * p.z(), 0, 0.98 * p.z()});
  }
  const auto evaluation = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, {});
  const auto& result = evaluation.alignments.front();
  EXPECT_NEAR(result.longitudinal.final, -1.0, 1e-9);  // 2 % short of 50 m
  EXPECT_NEAR(result.lateral.final, -0.5, 1e-9);       // to the right
  EXPECT_NEAR(result.longitudinal.mean_abs, 0.5, 1e-9);
  EXPECT_NEAR(result.longitudinal.max_abs, 1.0, 1e-9);
  EXPECT_NEAR(result.planar.final, std::hypot(1.0, 0.5), 1e-9);
  EXPECT_NEAR(result.vertical.rmse, 0.0, 1e-12);
}

TEST(Evaluation, RotationErrorIsAnAngle) {
  const auto truth = StraightAhead(11, 0.5);
  geometry::Trajectory estimate = truth;
  for (auto& pose : estimate) {
    pose.T_world_cam =
        geometry::SE3(geometry::so3::Exp({0, 0.1, 0}) * pose.T_world_cam.rotation(), pose.T_world_cam.translation());
  }
  const auto result = Evaluate(truth, estimate, std::vector{ParseAlignment("none")}, {}, {}).alignments.front();
  EXPECT_NEAR(result.Ape(PoseRelation::kRotationDeg).mean, 0.1 * 180.0 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(result.Ape(PoseRelation::kTranslation).max, 0.0, 1e-12);
}

TEST(Statistics, OfNothingAreNotNumbers) {
  EXPECT_EQ(ComputeStatistics({}).count, 0);
  EXPECT_TRUE(std::isnan(ComputeStatistics({}).rmse));
}

}  // namespace
}  // namespace evo::evaluation
