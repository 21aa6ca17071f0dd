#include "report/tables/segment_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace evo::report {
namespace {

/// 10 s along z at 10 m/s, 0.5 m a pose; the estimate is 2 % short.
evaluation::Evaluation Drive(const std::string& kitti_lengths, const std::string& subtrajectory_lengths) {
  geometry::Trajectory truth;
  geometry::Trajectory estimate;
  for (int i = 0; i <= 200; ++i) {
    const TimeNs t = i * (kNsPerSecond / 20);
    truth.push_back({t, geometry::SE3({1, 0, 0, 0}, {0, 0, 0.5 * i})});
    estimate.push_back({t, geometry::SE3({1, 0, 0, 0}, {0, 0, 0.49 * i})});
  }
  evaluation::EvaluationOptions options;
  options.segments.kitti_lengths_m = kitti_lengths;
  options.segments.subtrajectory_lengths = subtrajectory_lengths;
  return evaluation::Evaluate(truth, estimate, evaluation::ParseAlignments("none,origin"), {}, options);
}

std::string Text(const TableRow& row, std::size_t column) { return std::get<std::string>(row.at(column).second); }
double Number(const TableRow& row, std::size_t column) { return std::get<double>(row.at(column).second); }

TEST(SegmentRows, HaveOneRowForEachQuantityLengthAndAlignment) {
  const auto rows = SegmentMetricRows("day", Drive("20,40,500", "10%,50m,500"));
  ASSERT_EQ(rows.size(), 2U * (2 * 2 + 2 + 2 * 6));
  const std::vector<std::string> columns = {"sequence",   "alignment", "metric", "quantity", "unit", "delta",
                                            "delta_unit", "pairs",     "count",  "rmse",     "mean", "median",
                                            "std",        "min",       "max",    "sse"};
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i) EXPECT_EQ(row[i].first, columns[i]);
  }
  const auto& kitti = rows[0];
  EXPECT_EQ(Text(kitti, 0), "day");
  EXPECT_EQ(Text(kitti, 1), "none");
  EXPECT_EQ(Text(kitti, 2), "kitti");
  EXPECT_EQ(Text(kitti, 3), "translation");
  EXPECT_EQ(Text(kitti, 4), "%");
  EXPECT_EQ(Number(kitti, 5), 20.0);
  EXPECT_EQ(Text(kitti, 7), "every 10");
  EXPECT_EQ(std::get<std::int64_t>(kitti[8].second), 16);  // starts at 0, 5, ..., 75 m end 20.5 m on
  EXPECT_NEAR(Number(kitti, 10), 100.0 * 0.02 * 20.5 / 20.0, 1e-9);

  const auto& all_lengths = rows[4];
  EXPECT_TRUE(std::isnan(Number(all_lengths, 5)));
  EXPECT_EQ(std::get<std::int64_t>(all_lengths[8].second), 16 + 12);

  const auto& sub_trajectory = rows[6];
  EXPECT_EQ(Text(sub_trajectory, 2), "subtrajectory");
  EXPECT_EQ(Text(sub_trajectory, 4), "m");
  EXPECT_NEAR(Number(sub_trajectory, 5), 10.0, 1e-9);
  EXPECT_EQ(Text(sub_trajectory, 7), "all");
  EXPECT_NEAR(Number(sub_trajectory, 10), 0.2, 0.04);  // ends may be 20 % off at the end of the path
  EXPECT_NEAR(Number(sub_trajectory, 11), 0.2, 1e-9);
  EXPECT_EQ(Text(rows[18], 1), "origin");
}

TEST(SegmentRows, AreEmptyIfNoLengthFits) { EXPECT_TRUE(SegmentMetricRows("day", Drive("500", "500m")).empty()); }

TEST(SegmentRows, HandleAStandingCamera) {
  const geometry::Trajectory still = {{0, geometry::SE3()}, {kNsPerSecond / 10, geometry::SE3()}};
  const auto evaluation =
      evaluation::Evaluate(still, still, evaluation::ParseAlignments("none"), {}, evaluation::EvaluationOptions());
  EXPECT_TRUE(SegmentMetricRows("still", evaluation).empty());
  EXPECT_TRUE(std::isnan(evaluation.alignments[0].segments.local_scale.at(1).ratio));
}

}  // namespace
}  // namespace evo::report
