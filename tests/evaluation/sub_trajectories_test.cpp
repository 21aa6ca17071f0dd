#include "evaluation/trajectory/sub_trajectories.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "evaluation/reference.hpp"
#include "evaluation/trajectory/alignment_fit.hpp"

namespace evo::evaluation {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

using Row = std::map<std::string, std::string>;

/// The program's alignments over its first `n` pairs, -1 for all.
Similarity AlignAsReference(std::span<const PosePair> pairs, const std::string& alignment, int n) {
  std::string name = alignment == "se3" && n == 1 ? "origin" : alignment;
  if (n > 0 && name != "origin") name += ":" + std::to_string(n);
  return FitAlignment(pairs, ParseAlignment(name), kUp);
}

/// Pairs as the program makes them: stamps up to 0.02 s apart, the nearest first, each used once.
std::vector<PosePair> AssociateAsReference(const std::string& estimate) {
  AssociationOptions options;
  options.association = "unique";
  return Associate(ReadReferenceTrajectory("gt.txt"), ReadReferenceTrajectory(estimate + ".txt"), options);
}

std::map<std::string, Statistics> ByLabel(const SubTrajectoryErrors& errors) {
  return {{"trans", errors.translation_m}, {"trans_perc", errors.translation_percent},
          {"rot", errors.rotation_deg},    {"rot_deg_per_m", errors.rotation_deg_per_m},
          {"yaw", errors.yaw_deg},         {"gravity", errors.gravity_deg}};
}

std::map<std::string, Statistics> AbsoluteErrors(const MatchedTrajectory& path) {
  std::vector<double> translations;
  std::vector<double> rotations;
  for (std::size_t i = 0; i < path.size(); ++i) {
    translations.push_back((path.estimate[i] - path.truth[i]).norm());
    rotations.push_back(kDegrees * RotationAngle(path.rotation_error[i]));
  }
  return {{"trans", ComputeStatistics(translations)}, {"rot", ComputeStatistics(rotations)}};
}

/// Length of "relative_error_statistics_100_0", 0 for absolute errors.
double Length(const Row& row) {
  const std::string prefix = "relative_error_statistics_";
  const std::string& file = row.at("file");
  return file.starts_with(prefix) ? std::stod(file.substr(prefix.size())) : 0.0;
}

bool Coincide(const Statistics& statistics, const Row& row) {
  const auto agree = [&](double value, const char* column) {
    const double expected = std::stod(row.at(column));
    return std::abs(value - expected) <= 1e-9 * std::max(1.0, expected);
  };
  return statistics.count == std::stoll(row.at("n")) && agree(statistics.rmse, "rmse") &&
         agree(statistics.mean, "mean") && agree(statistics.median, "median") &&
         agree(statistics.standard_deviation, "std") && agree(statistics.min, "min") && agree(statistics.max, "max");
}

struct Reference {
  std::vector<Row> rows = ReadReferenceTable("rpg_reference.csv");
  std::map<std::string, std::vector<PosePair>> pairs;

  Reference() {
    for (const auto* name : {"est_sim3", "est_se3", "est_drift"}) pairs[name] = AssociateAsReference(name);
  }
  Similarity AlignRow(const Row& row) const {
    return AlignAsReference(pairs.at(row.at("est")), row.at("align"), std::stoi(row.at("n_align")));
  }
};

/// Ends of sub-trajectories by a plain search over all later poses; none is -1.
std::vector<int> FindEnds(const std::vector<double>& distance, double length) {
  std::vector<int> ends;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    double least = 0.2 * length;
    int end = -1;
    for (std::size_t j = i; j < distance.size(); ++j) {
      const double error = std::abs(distance[j] - (distance[i] + length));
      if (error >= least) continue;
      least = error;
      end = static_cast<int>(j);
    }
    ends.push_back(end);
  }
  return ends;
}

/// Errors between the poses i and ends[i].
std::map<std::string, Statistics> ErrorsBetween(const MatchedTrajectory& path, const std::vector<int>& ends,
                                                double length) {
  std::map<std::string, std::vector<double>> errors;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (ends[i] < 0) continue;
    const auto end = static_cast<std::size_t>(ends[i]);
    const Eigen::Matrix3d R = path.RotationError(i, end).toRotationMatrix();
    const double translation = path.TranslationError(i, end);
    const double angle = kDegrees * std::acos(std::clamp(0.5 * (R.trace() - 1.0), -1.0, 1.0));
    const double pitch = std::asin(std::clamp(-R(2, 0), -1.0, 1.0));
    const double roll = std::atan2(R(2, 1), R(2, 2));
    errors["trans"].push_back(translation);
    errors["trans_perc"].push_back(100.0 * translation / length);
    errors["rot"].push_back(angle);
    errors["rot_deg_per_m"].push_back(angle / length);
    errors["yaw"].push_back(kDegrees * std::abs(std::atan2(R(1, 0), R(0, 0))));
    errors["gravity"].push_back(kDegrees * std::hypot(pitch, roll));
  }
  std::map<std::string, Statistics> statistics;
  for (const auto& [label, values] : errors) statistics[label] = ComputeStatistics(values);
  return statistics;
}

/// The statistics that belong to a row: absolute errors over `absolute`, those of sub-trajectories over `relative`.
Statistics Find(const Row& row, const MatchedTrajectory& absolute, const MatchedTrajectory& relative) {
  const double length = Length(row);
  if (length == 0.0) return AbsoluteErrors(absolute).at(row.at("label"));
  return ByLabel(ComputeSubTrajectoryErrors(relative, std::vector{length}, kUp).at(0)).at(row.at("label"));
}

// The rows are seen in the program's own frame: of the alignment only the scale enters its relative errors, so that yaw
// and gravity are about the z axis of the estimate's world as it was written. (The reference leaves out the program's
// "scale" statistic, which compares distances from the origin where steps are meant.)
//
// All coincide but those of 10 m. The reference's estimates have a gap of 1.5 s, some 11 m, so that a few poses before
// it have no end within 8 to 12 m; the program loses count there and gives every later pose the end of an earlier one,
// as it happens with the same number of samples. With that repeated, those rows coincide too.
TEST(RpgReference, EveryRowCoincidesInTheProgramsFrame) {
  const Reference reference;
  std::map<double, int> rows;
  for (const auto& row : reference.rows) {
    const auto& pairs = reference.pairs.at(row.at("est"));
    const Similarity similarity = reference.AlignRow(row);
    const auto path = BuildMatchedTrajectory(pairs, {similarity.scale, geometry::SE3()});
    Statistics found = Find(row, BuildMatchedTrajectory(pairs, similarity), path);
    if (Length(row) == 10.0) {
      EXPECT_FALSE(Coincide(found, row));
      auto ends = FindEnds(path.distance, 10.0);
      std::erase(ends, -1);
      found = ErrorsBetween(path, ends, 10.0).at(row.at("label"));
    }
    EXPECT_TRUE(Coincide(found, row)) << row.at("est") << " " << row.at("align") << " " << row.at("n_align") << " "
                                      << row.at("file") << " " << row.at("label") << ": rmse " << found.rmse
                                      << " instead of " << row.at("rmse");
    ++rows[Length(row)];
  }
  EXPECT_EQ(rows, (std::map<double, int>{{0.0, 42}, {10.0, 126}, {50.0, 126}, {100.0, 126}, {200.0, 126}}));
}

// What `evo-run evaluate` prints is seen in the truth's world, after alignment. Translation and rotation are the same;
// yaw and gravity differ wherever the alignment rotates.
TEST(RpgReference, OnlyYawAndGravityDependOnTheFrame) {
  const Reference reference;
  std::map<std::string, int> coincide;
  std::map<std::string, int> differ;
  for (const auto& row : reference.rows) {
    if (Length(row) == 10.0) continue;
    const auto path = BuildMatchedTrajectory(reference.pairs.at(row.at("est")), reference.AlignRow(row));
    const bool turned = row.at("label") == "yaw" || row.at("label") == "gravity";
    ++(Coincide(Find(row, path, path), row) ? coincide : differ)[turned ? row.at("align") : "all"];
  }
  EXPECT_EQ(coincide, (std::map<std::string, int>{{"all", 294}, {"none", 18}}));
  EXPECT_EQ(differ, (std::map<std::string, int>{{"posyaw", 36}, {"se3", 54}, {"sim3", 18}}));
}

/// A wandering path with stops and leaps, the estimate off by noise.
std::vector<PosePair> Wander(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto vector = [&](double size) -> Eigen::Vector3d {
    return size * Eigen::Vector3d(normal(random), normal(random), normal(random));
  };
  std::vector<PosePair> pairs;
  geometry::SE3 truth;
  for (int i = 0; i < n; ++i) {
    const bool stands = random() % 3 == 0;
    const bool leaps = random() % 50 == 0;
    if (!stands) truth = truth * geometry::SE3(geometry::so3::Exp(vector(0.05)), vector(leaps ? 3.0 : 0.2));
    const geometry::SE3 error(geometry::so3::Exp(vector(0.01)), vector(0.02));
    pairs.push_back({i, i, truth * error, truth});
  }
  return pairs;
}

TEST(SubTrajectories, AgreeWithAnExhaustiveSearch) {
  const auto path = BuildMatchedTrajectory(Wander(500, 3), {});
  int passed_over = 0;
  for (const double length : {0.3, 2.0, 10.0, 40.0}) {
    const auto ends = FindEnds(path.distance, length);
    passed_over += static_cast<int>(std::ranges::count(ends, -1));
    const auto expected = ErrorsBetween(path, ends, length);
    const auto found = ByLabel(ComputeSubTrajectoryErrors(path, std::vector{length}, kUp).at(0));
    for (const auto& [label, statistics] : found) {
      EXPECT_EQ(statistics.count, expected.at(label).count) << label;
      EXPECT_NEAR(statistics.rmse, expected.at(label).rmse, 1e-9) << label;
      EXPECT_NEAR(statistics.median, expected.at(label).median, 1e-9) << label;
      EXPECT_NEAR(statistics.max, expected.at(label).max, 1e-9) << label;
      EXPECT_NEAR(statistics.sse / expected.at(label).sse, 1.0, 1e-9) << label;
    }
  }
  EXPECT_GT(passed_over, 0);
}

TEST(SubTrajectories, EndAtTheEarlierOfTwoEquallyNearPosesWithinTheTolerance) {
  const auto count_and_error = [](const std::vector<double>& truth, const std::vector<double>& estimate) {
    std::vector<PosePair> pairs;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const auto at = [](double x) { return geometry::SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0, 0)); };
      pairs.push_back({static_cast<TimeNs>(i), static_cast<TimeNs>(i), at(estimate[i]), at(truth[i])});
    }
    const auto errors = ComputeSubTrajectoryErrors(BuildMatchedTrajectory(pairs), std::vector{10.0}, kUp);
    return errors.empty() ? std::pair{0, 0.0}
                          : std::pair{static_cast<int>(errors[0].translation_m.count), errors[0].translation_m.max};
  };
  EXPECT_EQ(count_and_error({0, 9, 11}, {0, 9, 12}), std::pair(1, 0.0));
  EXPECT_EQ(count_and_error({0, 9, 10.5}, {0, 9, 11.5}), std::pair(1, 1.0));
  EXPECT_EQ(count_and_error({0, 9, 9, 12}, {0, 9, 10, 12}), std::pair(1, 0.0));  // the first of two at one place
  EXPECT_EQ(count_and_error({0, 12}, {0, 12}), std::pair(0, 0.0));               // 20 % off
  EXPECT_EQ(count_and_error({0, 8}, {0, 8}), std::pair(0, 0.0));
  EXPECT_EQ(count_and_error({0, 11.5}, {0, 11.5}), std::pair(1, 0.0));
}

TEST(SubTrajectories, SplitRotationIntoYawAndGravity) {
  const Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  std::vector<PosePair> pairs;
  for (int i = 0; i < 2; ++i) {
    const geometry::SE3 truth(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, 10.0 * i));
    const geometry::SE3 turned(geometry::so3::Exp(i * 0.02 * up), Eigen::Vector3d(0, 0.3 * i, 10.0 * i));
    pairs.push_back({i, i, turned, truth});
  }
  auto errors = ComputeSubTrajectoryErrors(BuildMatchedTrajectory(pairs, {}), std::vector{10.0}, up).at(0);
  EXPECT_EQ(errors.yaw_deg.count, 1);
  EXPECT_NEAR(errors.yaw_deg.mean, 0.02 * kDegrees, 1e-9);
  EXPECT_NEAR(errors.gravity_deg.mean, 0.0, 1e-9);
  EXPECT_NEAR(errors.rotation_deg_per_m.mean, 0.002 * kDegrees, 1e-9);
  EXPECT_NEAR(errors.translation_percent.mean, 3.0, 1e-9);

  pairs[1].T_world_cam_estimate = geometry::SE3(geometry::so3::Exp({0.03, 0, 0}), Eigen::Vector3d(0, 0, 10));
  errors = ComputeSubTrajectoryErrors(BuildMatchedTrajectory(pairs, {}), std::vector{10.0}, up).at(0);
  EXPECT_NEAR(errors.yaw_deg.mean, 0.0, 1e-9);
  EXPECT_NEAR(errors.gravity_deg.mean, 0.03 * kDegrees, 1e-9);
}

TEST(SubTrajectories, SkipLengthsThatDoNotFit) {
  const auto path = BuildMatchedTrajectory(Wander(50, 1), {});
  EXPECT_TRUE(ComputeSubTrajectoryErrors(path, std::vector{1e6}, kUp).empty());
  EXPECT_EQ(ComputeSubTrajectoryErrors(path, std::vector{1e6, 1.0}, kUp).size(), 1U);
  EXPECT_TRUE(ComputeSubTrajectoryErrors({}, std::vector{1.0}, kUp).empty());
  const std::vector<PosePair> still(20, Wander(1, 1).front());
  EXPECT_TRUE(ComputeSubTrajectoryErrors(BuildMatchedTrajectory(still, {}), std::vector{1.0}, kUp).empty());
}

}  // namespace
}  // namespace evo::evaluation
