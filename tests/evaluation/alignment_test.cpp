#include "evaluation/trajectory/alignment_fit.hpp"

#include <gtest/gtest.h>

#include <random>

#include "evaluation/reference.hpp"
#include "evo/core/error.hpp"
#include "evo/evaluation/evaluation.hpp"

namespace evo::evaluation {
namespace {

/// A pose a tenth of a second along a smooth curve in space.
geometry::Trajectory Curve(int poses) {
  geometry::Trajectory trajectory;
  for (int i = 0; i < poses; ++i) {
    const double s = 0.1 * i;
    trajectory.push_back({FromSeconds(s), geometry::SE3(geometry::so3::Exp({0.1 * s, 0.3 * std::sin(s), -0.05 * s}),
                                                        {3.0 * s, std::sin(0.7 * s), 0.2 * s * s})});
  }
  return trajectory;
}

geometry::Trajectory Noisy(geometry::Trajectory trajectory, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.1);
  for (auto& pose : trajectory) {
    const Eigen::Vector3d shift(noise(random), noise(random), noise(random));
    pose.T_world_cam = geometry::SE3(pose.T_world_cam.rotation(), pose.T_world_cam.translation() + shift);
  }
  return trajectory;
}

geometry::Trajectory Moved(geometry::Trajectory trajectory, const Similarity& similarity) {
  for (auto& pose : trajectory) pose.T_world_cam = similarity * pose.T_world_cam;
  return trajectory;
}

double Rmse(const geometry::Trajectory& truth, const geometry::Trajectory& estimate, const char* alignment) {
  return Evaluate(truth, estimate, std::vector{ParseAlignment(alignment)}, {}, {})
      .alignments.front()
      .Ape(PoseRelation::kTranslation)
      .rmse;
}

const Similarity kRigid{1.0, geometry::SE3(geometry::so3::Exp({0.4, -1.2, 2.0}), {100.0, -20.0, 3.0})};
const Similarity kSimilar{0.3, geometry::SE3(geometry::so3::Exp({0.4, -1.2, 2.0}), {100.0, -20.0, 3.0})};

TEST(Alignment, RecoversTheAppliedSimilarity) {
  const auto truth = Curve(80);
  for (const char* name : {"sim3", "origin-scale", "first:2.5"}) {
    EXPECT_LT(Rmse(truth, Moved(truth, kSimilar), name), 1e-9) << name;
    const auto pairs = Associate(truth, Moved(truth, kSimilar), {});
    EXPECT_NEAR(FitAlignment(pairs, ParseAlignment(name), Eigen::Vector3d::UnitZ()).scale, 1.0 / 0.3, 1e-9) << name;
  }
  for (const char* name : {"se3", "origin"}) EXPECT_LT(Rmse(truth, Moved(truth, kRigid), name), 1e-9) << name;
  EXPECT_GT(Rmse(truth, Moved(truth, kRigid), "none"), 1.0);
}

TEST(Alignment, ErrorsDoNotDependOnTheEstimatesWorldFrame) {
  const auto truth = Curve(80);
  const auto estimate = Noisy(truth, 1);
  for (const char* name : {"se3", "sim3", "origin", "origin-scale", "first:3"}) {
    EXPECT_NEAR(Rmse(truth, Moved(estimate, kRigid), name), Rmse(truth, estimate, name), 1e-9) << name;
  }
  for (const char* name : {"sim3", "origin-scale", "first:3"}) {
    EXPECT_NEAR(Rmse(truth, Moved(estimate, kSimilar), name), Rmse(truth, estimate, name), 1e-9) << name;
  }
}

TEST(Alignment, MoreDegreesOfFreedomNeverFitWorse) {
  const auto truth = Curve(80);
  const auto estimate = Moved(Noisy(truth, 2), {0.95, geometry::SE3(geometry::so3::Exp({0, 0.02, 0}), {0.5, 0, 0})});
  const double sim3 = Rmse(truth, estimate, "sim3");
  EXPECT_LE(sim3, Rmse(truth, estimate, "se3"));
  EXPECT_LE(Rmse(truth, estimate, "se3"), Rmse(truth, estimate, "origin"));
  EXPECT_LE(sim3, Rmse(truth, estimate, "origin-scale"));
  EXPECT_LE(Rmse(truth, estimate, "origin-scale"), Rmse(truth, estimate, "origin"));
}

TEST(Alignment, OriginScaleKeepsTheFirstPoseOnTheTruth) {
  const auto truth = Curve(60);
  const auto result =
      Evaluate(truth, Moved(Noisy(truth, 3), kSimilar), std::vector{ParseAlignment("origin-scale")}, {}, {})
          .alignments.front();
  EXPECT_NEAR(result.errors.front().translation, 0.0, 1e-9);
  EXPECT_NEAR(result.errors.front().rotation_deg, 0.0, 1e-6);
  EXPECT_GT(result.errors.back().translation, 0.0);
}

TEST(Alignment, ReflectionIsNeverUsed) {
  const auto truth = Curve(60);
  auto mirrored = truth;
  for (auto& pose : mirrored) {
    const Eigen::Vector3d p = pose.T_world_cam.translation();
    pose.T_world_cam = geometry::SE3(pose.T_world_cam.rotation(), {p.x(), -p.y(), p.z()});
  }
  const auto pairs = Associate(truth, mirrored, {});
  EXPECT_NEAR(FitAlignment(pairs, ParseAlignment("se3"), Eigen::Vector3d::UnitZ())
                  .T_truth_estimate.RotationMatrix()
                  .determinant(),
              1.0, 1e-12);
  EXPECT_GT(Rmse(truth, mirrored, "se3"), 0.1);
}

ErrorKind Refusal(const geometry::Trajectory& truth, const geometry::Trajectory& estimate, const char* alignment) {
  try {
    Rmse(truth, estimate, alignment);
  } catch (const Error& error) {
    return error.kind();
  }
  ADD_FAILURE() << "accepted " << alignment;
  return ErrorKind::kUsage;
}

TEST(Alignment, RefusesDegeneratePoses) {
  for (const char* file : {"line.txt", "still.txt", "two.txt"}) {
    const auto trajectory = ReadReferenceTrajectory(file);
    for (const char* alignment : {"se3", "sim3", "first:1"}) {
      EXPECT_EQ(Refusal(trajectory, trajectory, alignment), ErrorKind::kDegenerateAlignment) << file << alignment;
    }
    EXPECT_NEAR(Rmse(trajectory, trajectory, "origin"), 0.0, 1e-12);
  }
  const auto still = ReadReferenceTrajectory("still.txt");
  EXPECT_EQ(Refusal(still, still, "origin-scale"), ErrorKind::kDegenerateAlignment);
  const auto line = ReadReferenceTrajectory("line.txt");
  EXPECT_NEAR(Rmse(line, line, "origin-scale"), 0.0, 1e-12);
  EXPECT_EQ(Refusal(line, Moved(line, {-1.0, geometry::SE3()}), "origin-scale"), ErrorKind::kDegenerateAlignment);
}

TEST(Alignment, NoOverlapIsNothingToDo) {
  const auto truth = ReadReferenceTrajectory("gt.txt");
  EXPECT_EQ(Refusal(truth, ReadReferenceTrajectory("nooverlap.txt"), "se3"), ErrorKind::kNothingToDo);
  EXPECT_EQ(Refusal(truth, {}, "none"), ErrorKind::kNothingToDo);
  EXPECT_EQ(Refusal({}, truth, "none"), ErrorKind::kNothingToDo);
}

TEST(Alignment, ScaleIsThatOfSim3AboutTheOrigin) {
  const auto truth = Curve(80);
  const auto pairs = Associate(truth, Moved(Noisy(truth, 4), kSimilar), {});
  const auto scale = FitAlignment(pairs, ParseAlignment("scale"), Eigen::Vector3d::UnitZ());
  EXPECT_DOUBLE_EQ(scale.scale, FitAlignment(pairs, ParseAlignment("sim3"), Eigen::Vector3d::UnitZ()).scale);
  EXPECT_EQ(scale.T_truth_estimate.Matrix(), Eigen::Matrix4d::Identity());
}

TEST(Alignment, PosYawRecoversPositionAndYawOnly) {
  const auto truth = Curve(80);
  const Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  const Similarity turned{1.0, geometry::SE3(geometry::so3::Exp(-2.5 * up), {4.0, 5.0, -6.0})};
  const auto tilted = Moved(truth, {1.0, geometry::SE3(geometry::so3::Exp({0.2, 0.0, 0.0}), Eigen::Vector3d::Zero())});
  for (const char* name : {"posyaw", "posyaw:1", "posyaw:7", "posyaw:2.5s"}) {
    const auto found = FitAlignment(Associate(truth, Moved(truth, turned), {}), ParseAlignment(name), up);
    const geometry::SE3 rest = found.T_truth_estimate * turned.T_truth_estimate;
    EXPECT_LT((rest.Matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-9) << name;
    const auto level = FitAlignment(Associate(truth, tilted, {}), ParseAlignment(name), up);
    EXPECT_LT((level.T_truth_estimate.rotation() * up - up).norm(), 1e-12) << name;
  }
}

TEST(Alignment, PosYawMinimisesTheErrorOverAllYaws) {
  const auto truth = Curve(80);
  const auto pairs = Associate(truth, Noisy(Moved(truth, kRigid), 5), {});
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const auto cost = [&](const geometry::SE3& T) {
    double sum = 0.0;
    for (const auto& pair : pairs) {
      sum += (T * pair.T_world_cam_estimate.translation() - pair.T_world_cam_truth.translation()).squaredNorm();
    }
    return sum;
  };
  const geometry::SE3 best = FitAlignment(pairs, ParseAlignment("posyaw"), up).T_truth_estimate;
  for (const double step : {-0.01, 0.01}) {
    EXPECT_LT(cost(best), cost(geometry::SE3(geometry::so3::Exp(step * up), Eigen::Vector3d::Zero()) * best));
    EXPECT_LT(cost(best), cost(geometry::SE3(Eigen::Quaterniond::Identity(), {step, step, step}) * best));
  }
}

TEST(Alignment, SpansSelectPosesOrSeconds) {
  const auto truth = Curve(80);  // ten poses a second
  const auto pairs = Associate(truth, Noisy(truth, 6), {});
  const auto align = [&](std::span<const PosePair> part, const char* name) {
    return FitAlignment(part, ParseAlignment(name), Eigen::Vector3d::UnitZ()).T_truth_estimate.Matrix();
  };
  const std::span first(pairs.data(), 31);
  for (const std::string method : {"se3", "sim3", "posyaw", "scale", "origin-scale"}) {
    const auto expected = align(first, method.c_str());
    EXPECT_EQ(align(pairs, (method + ":31").c_str()), expected) << method;
    EXPECT_EQ(align(pairs, (method + ":3s").c_str()), expected) << method;
    EXPECT_EQ(align(pairs, (method + ":1000").c_str()), align(pairs, method.c_str())) << method;
  }
  EXPECT_EQ(align(pairs, "first:3"), align(pairs, "sim3:3s"));
  EXPECT_NE(align(pairs, "sim3:3s"), align(pairs, "sim3"));
}

TEST(Alignment, PosYawRefusesVerticalMotion) {
  geometry::Trajectory lift;
  for (int i = 0; i < 20; ++i)
    lift.push_back({i * kNsPerSecond, geometry::SE3(Eigen::Quaterniond::Identity(), {0, 0, 0.5 * i})});
  const auto pairs = Associate(lift, lift, {});
  EXPECT_THROW(FitAlignment(pairs, ParseAlignment("posyaw"), Eigen::Vector3d::UnitZ()), Error);
  EXPECT_EQ(FitAlignment(pairs, ParseAlignment("posyaw:1"), Eigen::Vector3d::UnitZ()).scale, 1.0);
}

TEST(Alignment, ParsesNames) {
  const auto alignments = ParseAlignments("none,first:2.5,sim3,none");
  ASSERT_EQ(alignments.size(), 3u);
  EXPECT_EQ(alignments[1].method, Alignment::Method::kSim3);
  EXPECT_EQ(alignments[1].first_seconds, 2.5);
  for (const char* text :
       {"", "umeyama", "first:", "first:0", "first:-1", "first:nan", "first:2s", "sim3,,se3", "sim3:", "sim3:0",
        "sim3:2.5", "sim3:-3s", "sim3:3m", "none:3", "origin:1", "sim3:nan", "sim3:5s5"}) {
    EXPECT_THROW(ParseAlignments(text), Error) << text;
  }
}

}  // namespace
}  // namespace evo::evaluation
