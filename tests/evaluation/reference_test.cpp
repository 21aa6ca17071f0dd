// The numbers that other evaluators print for the same files: evo 1.36.5 (every row of its table, driven by the command
// written beside it), the TUM RGB-D tools, and driving errors computed independently.
#include "evaluation/reference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "evo/core/error.hpp"
#include "evo/evaluation/evaluation.hpp"

namespace evo::evaluation {
namespace {

/// What a command line of evo asks for, in our terms.
struct Question {
  bool relative = false;
  bool kitti = false;
  std::string truth;
  std::string estimate;
  PoseRelation relation = PoseRelation::kTranslation;
  std::string alignment = "none";
  EvaluationInterval interval;
  EvaluationOptions options;
};

PoseRelation RelationOf(const std::string& name) {
  if (name == "trans_part") return PoseRelation::kTranslation;
  if (name == "angle_deg") return PoseRelation::kRotationDeg;
  if (name == "full") return PoseRelation::kFull;
  if (name == "rot_part") return PoseRelation::kRotationFrobenius;
  if (name == "point_distance") return PoseRelation::kPointDistance;
  if (name == "point_distance_error_ratio") return PoseRelation::kPointDistanceRatio;
  throw std::invalid_argument("relation " + name);
}

Question ReadCommand(const std::string& command) {
  std::istringstream words(command);
  Question question;
  std::string tool;
  std::string format;
  words >> tool >> format >> question.truth >> question.estimate;
  question.relative = tool == "evo_rpe";
  question.kitti = format == "kitti";
  question.options.association.association = question.kitti ? "index" : "nearest";
  std::string delta = "1";
  std::string unit = "f";
  std::string n_to_align;
  const auto next = [&] {
    std::string word;
    words >> word;
    return word;
  };
  for (std::string flag; words >> flag;) {
    if (flag == "-a")
      question.alignment = "se3";
    else if (flag == "-as")
      question.alignment = "sim3";
    else if (flag == "-s")
      question.alignment = "scale";
    else if (flag == "--align_origin")
      question.alignment = "origin";
    else if (flag == "--n_to_align")
      n_to_align = ":" + next();
    else if (flag == "-r")
      question.relation = RelationOf(next());
    else if (flag == "--project_to_plane")
      question.options.project = next();
    else if (flag == "--t_max_diff")
      question.options.association.max_difference_s = std::stod(next());
    else if (flag == "--t_offset")
      question.options.association.estimate_clock_offset_s = std::stod(next());
    else if (flag == "--t_start")
      question.interval.from = ParseTime(next());
    else if (flag == "--t_end")
      question.interval.to = ParseTime(next());
    else if (flag == "-d")
      delta = next();
    else if (flag == "-u")
      unit = next();
    else if (flag == "-t")
      question.options.rpe.tolerance = std::stod(next());
    else if (flag == "--all_pairs")
      question.options.rpe.pairs = "all";
    else if (flag == "--pairs_from_reference")
      question.options.rpe.pairs_from = "truth";
    else
      throw std::invalid_argument("flag " + flag);
  }
  question.alignment += n_to_align;
  question.options.rpe.deltas = delta + (unit == "d" ? "deg" : unit);
  question.options.rpe.required = question.relative;
  return question;
}

Statistics Answer(const Question& question) {
  const auto read = [&](const std::string& path) {
    const auto file = ReferencePath(std::filesystem::path(path).filename());
    return question.kitti ? io::ReadKitti(file) : io::ReadTum(file);
  };
  const auto evaluation =
      Evaluate(read(question.truth), read(question.estimate), std::vector{ParseAlignment(question.alignment)},
               question.interval, question.options);
  const auto& result = evaluation.alignments.front();
  return question.relative ? Find(result.rpe.front().relations, question.relation) : result.Ape(question.relation);
}

void ExpectEqual(double actual, const std::string& expected, double tolerance, const std::string& place) {
  const double value = std::stod(expected);
  EXPECT_NEAR(actual, value, tolerance * std::max(1.0, std::abs(value))) << place;
}

/// All of them but the sum of squares, with those of a row.
void ExpectEqual(const Statistics& statistics, const std::map<std::string, std::string>& row, double tolerance,
                 const std::string& name) {
  EXPECT_EQ(statistics.count, std::stoll(row.at("n"))) << name;
  ExpectEqual(statistics.rmse, row.at("rmse"), tolerance, name + " rmse");
  ExpectEqual(statistics.mean, row.at("mean"), tolerance, name + " mean");
  ExpectEqual(statistics.median, row.at("median"), tolerance, name + " median");
  ExpectEqual(statistics.standard_deviation, row.at("std"), tolerance, name + " std");
  ExpectEqual(statistics.min, row.at("min"), tolerance, name + " min");
  ExpectEqual(statistics.max, row.at("max"), tolerance, name + " max");
}

TEST(EvoReference, EveryRowOfEvosTable) {
  int rows = 0;
  for (const auto& row : ReadReferenceTable("reference.csv")) {
    const std::string& name = row.at("name");
    const Question question = ReadCommand(row.at("command"));
    const Statistics statistics = Answer(question);
    const double tolerance = question.kitti ? 1e-6 : 1e-9;
    ExpectEqual(statistics, row, tolerance, name);
    ExpectEqual(statistics.sse, row.at("sse"), tolerance, name + " sse");
    ++rows;
  }
  EXPECT_EQ(rows, 114);
}

/// Empty if the question was answered.
std::optional<ErrorKind> Refusal(const Question& question) {
  try {
    Answer(question);
    return std::nullopt;
  } catch (const Error& error) {
    EXPECT_FALSE(std::string(error.what()).empty());
    return error.kind();
  }
}

TEST(EvoReference, RefusesWhatEvoRefuses) {
  const std::map<std::string, ErrorKind> refused{
      {"ape_se3_d002_est_sim3", ErrorKind::kNothingToDo},  {"ape_se3_d002_est_se3", ErrorKind::kNothingToDo},
      {"ape_se3_d002_est_drift", ErrorKind::kNothingToDo}, {"deg_line", ErrorKind::kDegenerateAlignment},
      {"deg_still", ErrorKind::kDegenerateAlignment},      {"deg_two", ErrorKind::kDegenerateAlignment},
      {"deg_nooverlap", ErrorKind::kNothingToDo},          {"deg_missing", ErrorKind::kInput}};
  std::map<std::string, std::string> status;
  std::ifstream statuses(ReferencePath("rc.txt"));
  for (std::string name, rc; statuses >> name >> rc;) status[name] = rc;
  ASSERT_EQ(status.size(), 122u);
  std::ifstream commands(ReferencePath("commands.txt"));
  int rows = 0;
  for (std::string line; std::getline(commands, line); ++rows) {
    const auto tab = line.find('\t');
    const std::string name = line.substr(0, tab);
    ASSERT_TRUE(status.contains(name)) << name;
    ASSERT_EQ(status.at(name) != "rc=0", refused.contains(name)) << name;
    const auto refusal = Refusal(ReadCommand(line.substr(tab + 1)));
    EXPECT_EQ(refusal, refused.contains(name) ? std::optional(refused.at(name)) : std::nullopt) << name;
  }
  EXPECT_EQ(rows, 122);
}

/// The lines "NAME VALUE UNIT" of a TUM tool.
std::map<std::string, std::string> ReadTumAnswer(const std::string& file) {
  std::ifstream lines(ReferencePath(file));
  std::map<std::string, std::string> answer;
  for (std::string name, value, unit; lines >> name >> value >> unit;) answer[name] = value;
  return answer;
}

void ExpectPrinted(const Statistics& statistics, const std::map<std::string, std::string>& answer,
                   const std::string& quantity) {
  constexpr double kPrinted = 0.5e-6 + 1e-9;  // six decimals
  EXPECT_EQ(statistics.count, std::stoll(answer.at("compared_pose_pairs")));
  EXPECT_NEAR(statistics.rmse, std::stod(answer.at(quantity + ".rmse")), kPrinted);
  EXPECT_NEAR(statistics.mean, std::stod(answer.at(quantity + ".mean")), kPrinted);
  EXPECT_NEAR(statistics.median, std::stod(answer.at(quantity + ".median")), kPrinted);
  EXPECT_NEAR(statistics.standard_deviation, std::stod(answer.at(quantity + ".std")), kPrinted);
  EXPECT_NEAR(statistics.min, std::stod(answer.at(quantity + ".min")), kPrinted);
  EXPECT_NEAR(statistics.max, std::stod(answer.at(quantity + ".max")), kPrinted);
}

class TumReference : public ::testing::TestWithParam<std::string> {
 protected:
  AlignedEvaluation Run(const char* alignment, const EvaluationOptions& options) const {
    return Evaluate(ReadReferenceTrajectory("gt.txt"), ReadReferenceTrajectory(GetParam() + ".txt"),
                    std::vector{ParseAlignment(alignment)}, {}, options)
        .alignments.front();
  }
};

TEST_P(TumReference, EvaluateAte) {
  EvaluationOptions options;
  options.association.association = "unique";
  ExpectPrinted(Run("se3", options).Ape(PoseRelation::kTranslation), ReadTumAnswer("tum_ate_" + GetParam() + ".txt"),
                "absolute_translational_error");
}

TEST_P(TumReference, EvaluateRpe) {
  EvaluationOptions options;
  options.association.association = "nearest-truth";
  options.rpe.pairs = "closest";
  options.rpe.deltas = "10f,1s,10m,5deg";
  const auto results = Run("none", options).rpe;
  ASSERT_EQ(results.size(), 4u);
  for (const auto& result : results) {
    SCOPED_TRACE(result.delta.name);
    const std::string unit = UnitName(result.delta.unit);
    const auto answer = ReadTumAnswer("tum_rpe_" + unit + "_" + GetParam() + ".txt");
    ExpectPrinted(Find(result.relations, PoseRelation::kTranslation), answer, "translational_error");
    ExpectPrinted(Find(result.relations, PoseRelation::kRotationDeg), answer, "rotational_error");
  }
}

INSTANTIATE_TEST_SUITE_P(Tum, TumReference, ::testing::Values("est_se3", "est_dense", "est_drift"),
                         [](const auto& test) { return test.param; });

/// rpg_trajectory_evaluation's absolute errors: it associates as evaluate_ate does, and its up is z.
TEST(RpgReference, AbsoluteErrorsOfEveryAlignment) {
  int rows = 0;
  for (const auto& row : ReadReferenceTable("rpg_reference.csv")) {
    if (!row.at("file").starts_with("absolute_err") || row.at("label") == "scale") continue;
    const std::string method = row.at("align");
    const std::string span = row.at("n_align") == "-1" ? "" : ":" + row.at("n_align");
    EvaluationOptions options;
    options.association.association = "unique";
    options.up = "z";
    const auto relation = row.at("label") == "rot" ? PoseRelation::kRotationDeg : PoseRelation::kTranslation;
    const std::string name = row.at("est") + " " + method + span + " " + row.at("label");
    const auto alignment = ParseAlignment(method == "se3" && span == ":1" ? "origin" : method + span);
    const auto evaluation = Evaluate(ReadReferenceTrajectory("gt.txt"), ReadReferenceTrajectory(row.at("est") + ".txt"),
                                     std::vector{alignment}, {}, options);
    const Statistics& statistics = evaluation.alignments.front().Ape(relation);
    ExpectEqual(statistics, row, 1e-9, name);
    ++rows;
  }
  EXPECT_EQ(rows, 42);
}

TEST(PathFrameReference, ResolvesAlongTravelAndBody) {
  const auto rows = ReadReferenceTable("lonlat_reference.csv");
  ASSERT_EQ(rows.size(), 2u);
  for (const auto& row : rows) {
    const std::string& frame = row.at("frame");
    EvaluationOptions options;
    options.association.association = "nearest";
    options.forward = frame == "gt-body" ? "body" : frame;
    const auto evaluation = Evaluate(ReadReferenceTrajectory("gt.txt"), ReadReferenceTrajectory(row.at("est") + ".txt"),
                                     std::vector{ParseAlignment(row.at("align"))}, {}, options);
    const auto& result = evaluation.alignments.front();
    const auto expect = [&](const char* column, double value) {
      ExpectEqual(value, row.at(column), 1e-9, frame + " " + column);
    };
    const double percent = 100.0 / evaluation.path_m;
    EXPECT_EQ(result.errors.size(), std::stoull(row.at("n")));
    expect("path_m", evaluation.path_m);
    expect("mean_abs_lon", result.longitudinal.mean_abs);
    expect("mean_abs_lat", result.lateral.mean_abs);
    expect("mean_planar", result.planar.mean_abs);
    expect("rmse_planar", result.planar.rmse);
    expect("max_lon", result.longitudinal.max_abs);
    expect("max_lat", result.lateral.max_abs);
    expect("max_planar", result.planar.max_abs);
    expect("final_planar", result.planar.final);
    expect("max_planar_pct", percent * result.planar.max_abs);
    expect("final_planar_pct", percent * result.planar.final);
    expect("max_lon_pct", percent * result.longitudinal.max_abs);
    expect("max_lat_pct", percent * result.lateral.max_abs);
  }
}

}  // namespace
}  // namespace evo::evaluation
