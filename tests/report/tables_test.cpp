#include "evo/report/tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "evo/core/error.hpp"
#include "evo/report/evaluation_tables.hpp"
#include "evo/report/manifest.hpp"
#include "evo/report/terminal_summary.hpp"
#include "report/fixtures.hpp"
#include "report/tables/metric_row.hpp"

namespace evo::report {
namespace {

using TablesTest = ReportTest;

TEST_F(TablesTest, ErrorsHaveOneRowAPose) {
  const auto evaluation = SampleEvaluation();
  WriteErrors(folder / "errors.csv", evaluation.alignments[0].errors, true);
  std::istringstream lines(ReadFile(folder / "errors.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "stamp,distance,longitudinal,lateral,vertical,planar,translation,rotation_deg");
  std::getline(lines, line);
  EXPECT_EQ(line, "0.000000000,0.000000000,0.000000000,0.000000000,0.000000000,0.000000000,0.000000000,0.000000000");
  std::string last;
  int rows = 1;
  for (; std::getline(lines, line); ++rows) last = line;
  EXPECT_EQ(rows, 182);
  EXPECT_EQ(last,
            "10.000000000,100.000000000,-2.000000000,0.000000000,0.000000000,2.000000000,2.000000000,0.000000000");
}

TEST_F(TablesTest, SummaryColumnsAreStable) {
  WriteCsv(folder / "summary.csv", SummaryRows("drive, \"day\"", SampleEvaluation()));
  const std::string csv = ReadFile(folder / "summary.csv");
  EXPECT_TRUE(csv.starts_with(
      "sequence,alignment,scale,poses,coverage,gaps,path_m,mean_abs_longitudinal_m,mean_abs_lateral_m,"
      "mean_abs_vertical_m,mean_planar_m,rmse_longitudinal_m,rmse_lateral_m,rmse_vertical_m,rmse_planar_m,"
      "max_longitudinal_m,max_lateral_m,max_vertical_m,max_planar_m,final_longitudinal_m,final_lateral_m,"
      "final_vertical_m,final_planar_m,mean_abs_longitudinal_percent,mean_abs_lateral_percent,"
      "mean_abs_vertical_percent,mean_planar_percent,rmse_longitudinal_percent,rmse_lateral_percent,"
      "rmse_vertical_percent,rmse_planar_percent,max_longitudinal_percent,max_lateral_percent,max_vertical_percent,"
      "max_planar_percent,final_longitudinal_percent,final_lateral_percent,final_vertical_percent,"
      "final_planar_percent,ape_rmse_m,ape_mean_m,ape_median_m,ape_std_m,ape_min_m,ape_max_m,ape_sse_m2,"
      "ape_rotation_rmse_deg,ape_rotation_mean_deg,ape_rotation_max_deg,rpe_delta,rpe_translation_rmse_m,"
      "rpe_rotation_rmse_deg,mean_abs_longitudinal_over_distance_percent,mean_abs_lateral_over_distance_percent,"
      "mean_abs_vertical_over_distance_percent,mean_planar_over_distance_percent,rebootstraps,"
      "kitti_translation_percent,kitti_rotation_deg_per_m,nees_translation,nees_rotation,nees_pose\n"))
      << csv;
  EXPECT_NE(csv.find("\n\"drive, \"\"day\"\"\",none,1.000000000,182,0.900000000,1,100.000000000,"), std::string::npos)
      << csv;
  EXPECT_NE(csv.find("\n\"drive, \"\"day\"\"\",origin,"), std::string::npos) << csv;
}

TEST_F(TablesTest, SummaryHoldsRelativeErrorsAndReinitialisations) {
  const auto find = [](const TableRow& row, const std::string& name) {
    return std::ranges::find(row, name, [](const auto& cell) { return cell.first; })->second;
  };
  const auto row = SummaryRows("day", SampleEvaluation(), 3).front();
  WriteCsv(folder / "summary.csv", {row});
  // Of a frame 0.49 m instead of 0.5 m, but for the one second without poses: 19 frames less.
  EXPECT_NE(ReadFile(folder / "summary.csv").find(",1f,0.01"), std::string::npos);
  EXPECT_EQ(std::get<std::int64_t>(find(row, "rebootstraps")), 3);
  const auto unknown = SummaryRows("day", SampleEvaluation()).front();
  EXPECT_TRUE(std::isnan(std::get<double>(find(unknown, "rebootstraps"))));
  EXPECT_NEAR(std::get<double>(find(row, "mean_planar_over_distance_percent")), 2.0, 1e-9);
}

TEST_F(TablesTest, MetricsHaveAllDigits) {
  WriteCsv(folder / "metrics.csv", MetricRows("day", SampleEvaluation()), Digits::kAll);
  std::istringstream lines(ReadFile(folder / "metrics.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line,
            "sequence,alignment,metric,quantity,unit,delta,delta_unit,pairs,count,rmse,mean,median,std,min,max,sse");
  int rows = 0;
  for (; std::getline(lines, line); ++rows) EXPECT_EQ(std::ranges::count(line, ','), 15) << line;
  EXPECT_EQ(rows, 2 * (5 + 3 * 7 + 5 * 6));
  const evaluation::Statistics third{1, 1.0 / 3.0, 1e-20, 0.0, 0.0, 0.0, 0.0, 0.0};
  const MetricKey key{.sequence = "a",
                      .alignment = "b",
                      .metric = "c",
                      .quantity = "d",
                      .unit = "m",
                      .delta = 0.1,
                      .delta_unit = "s",
                      .pairs = "all"};
  WriteCsv(folder / "one.csv", {MetricRow(key, third)}, Digits::kAll);
  EXPECT_NE(ReadFile(folder / "one.csv").find("\na,b,c,d,m,0.1,s,all,1,0.3333333333333333,1e-20,0,0,0,0,0\n"),
            std::string::npos);
}

TEST_F(TablesTest, FilesWithoutStampsNameFrames) {
  evaluation::PoseError error;
  error.stamp = 7 * kNsPerSecond;
  WriteErrors(folder / "errors.csv", {error}, false);
  EXPECT_NE(ReadFile(folder / "errors.csv").find("\n7,0.000000000,"), std::string::npos);
  EXPECT_TRUE(ReadFile(folder / "errors.csv").starts_with("frame,"));
}

TEST_F(TablesTest, JsonEqualsCsv) {
  const auto rows = SummaryRows("day", SampleEvaluation());
  WriteJson(folder / "summary.json", rows);
  const auto json = nlohmann::json::parse(ReadFile(folder / "summary.json"));
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["sequence"], "day");
  EXPECT_EQ(json[1]["alignment"], "origin");
  EXPECT_EQ(json[0]["poses"], 182);
  EXPECT_NEAR(json[0]["final_longitudinal_m"].get<double>(), -2.0, 1e-12);
  EXPECT_NEAR(json[0]["max_planar_percent"].get<double>(), 2.0, 1e-12);
  EXPECT_EQ(json[0].size(), rows[0].size());
}

TEST_F(TablesTest, NoPathLeavesPercentagesEmpty) {
  geometry::Trajectory still;
  for (int i = 0; i < 5; ++i) still.push_back({i * kNsPerSecond / 10, geometry::SE3()});
  const auto rows = SummaryRows("still", evaluation::Evaluate(still, still, evaluation::ParseAlignments("none"), {},
                                                              evaluation::EvaluationOptions()));
  WriteCsv(folder / "summary.csv", rows);
  EXPECT_NE(ReadFile(folder / "summary.csv").find(",,,,"), std::string::npos);
  WriteJson(folder / "summary.json", rows);
  EXPECT_TRUE(nlohmann::json::parse(ReadFile(folder / "summary.json"))[0]["mean_planar_percent"].is_null());
}

TEST_F(TablesTest, LifetimesAreOneTable) {
  evaluation::LifetimeStatistics statistics;
  statistics.frames = 480;
  statistics.tracks = 2;
  statistics.in_frames = {4.0, 1.0, 4.0, 5.0};
  statistics.in_seconds = {0.1, 0.025, 0.1, 0.125};
  statistics.frame_interval_s = 0.025;
  statistics.histogram = {{3, 4, 1}, {4, 5, 0}, {5, 6, 1}};
  statistics.histogram_seconds = {{0.0, 0.1, 1}, {0.1, 0.2, 1}};
  WriteLifetimes(folder / "lifetime.csv", statistics);
  EXPECT_EQ(ReadFile(folder / "lifetime.csv"),
            "quantity,unit,bin_low,bin_high,value\n"
            "frames,count,,,480\n"
            "frame_interval,s,,,0.025000000\n"
            "tracks,count,,,2\n"
            "tracks_too_short,count,,,0\n"
            "tracks_cut_short,count,,,0\n"
            "mean,frames,,,4.000000000\n"
            "standard_deviation,frames,,,1.000000000\n"
            "median,frames,,,4.000000000\n"
            "max,frames,,,5.000000000\n"
            "mean,s,,,0.100000000\n"
            "standard_deviation,s,,,0.025000000\n"
            "median,s,,,0.100000000\n"
            "max,s,,,0.125000000\n"
            "histogram,tracks,3,4,1\n"
            "histogram,tracks,4,5,0\n"
            "histogram,tracks,5,6,1\n"
            "histogram_s,tracks,0.000000000,0.100000000,1\n"
            "histogram_s,tracks,0.100000000,0.200000000,1\n");
}

TEST_F(TablesTest, TerminalSummaryIsAligned) {
  std::istringstream lines(FormatSummary(SampleEvaluation()));
  std::vector<std::string> table;
  for (std::string line; std::getline(lines, line);) table.push_back(line);
  ASSERT_EQ(table.size(), 5u);
  EXPECT_EQ(table[0], "path 100.00 m, 10.00 s, coverage 90.0 %, gaps 1, up -y");
  for (std::size_t i = 2; i < table.size(); ++i) EXPECT_EQ(table[i].size(), table[1].size());
  EXPECT_TRUE(table[4].starts_with("origin "));
  evaluation::Evaluation with_covariances = SampleEvaluation();
  with_covariances.nees.emplace();
  with_covariances.nees->rotation.mean = 1.5;
  EXPECT_NE(FormatSummary(with_covariances).find("rotation 1.50"), std::string::npos);
  const auto row = SummaryRows("day", with_covariances).front();
  const auto cell = std::ranges::find(row, "nees_rotation", [](const auto& c) { return std::string(c.first); });
  ASSERT_NE(cell, row.end());
  EXPECT_EQ(std::get<double>(cell->second), 1.5);
}

TEST_F(TablesTest, ManifestHoldsTheRun) {
  Manifest manifest;
  manifest.version = "1.2.3";
  manifest.command_line = {"evo-run", "evaluate"};
  manifest.parameters = {{"evaluation.up", "auto"}, {"evaluation.chord_m", "1.5"}, {"odometry.refine", "true"}};
  manifest.inputs = {{"estimate", "x.txt", 12, "abc"}};
  manifest.counts = {{"poses", 7}};
  manifest.stages = {{"evaluate", 0.5}};
  manifest.rebootstraps = {1'500'000'000};
  manifest.scale = "ground";
  WriteManifest(folder / "manifest.json", manifest);
  const auto json = nlohmann::json::parse(ReadFile(folder / "manifest.json"));
  EXPECT_EQ(json["tool"], "evo-run");
  EXPECT_EQ(json["version"], "1.2.3");
  EXPECT_EQ(json["command_line"].size(), 2u);
  EXPECT_EQ(json["parameters"]["evaluation"]["up"], "auto");
  EXPECT_EQ(json["parameters"]["evaluation"]["chord_m"], 1.5);
  EXPECT_EQ(json["parameters"]["odometry"]["refine"], true);
  EXPECT_EQ(json["inputs"][0]["bytes"], 12);
  EXPECT_EQ(json["inputs"][0]["sha256"], "abc");
  EXPECT_EQ(json["counts"]["poses"], 7);
  EXPECT_EQ(json["wall_time_s"]["evaluate"], 0.5);
  EXPECT_EQ(json["rebootstraps"][0], "1.500000000");
  EXPECT_EQ(json["scale"], "ground");
  EXPECT_EQ(ReadManifest(folder / "manifest.json").scale, "ground");
  EXPECT_GT(json["peak_memory_mb"].get<double>(), 1.0);
  EXPECT_GT(json["cpu_time_s"].get<double>(), 0.0);
}

TEST_F(TablesTest, CannotWriteIsAnOutputError) {
  std::ofstream(folder / "file") << "x";
  try {
    WriteErrors(folder / "file" / "errors.csv", {}, true);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kOutput);
  }
}

}  // namespace
}  // namespace evo::report
