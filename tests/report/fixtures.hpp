#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "evo/evaluation/evaluation.hpp"

namespace evo::report {

/// A folder of its own for each test.
class ReportTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  static std::string ReadFile(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file.is_open()) << path;
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::filesystem::path folder =
      std::filesystem::temp_directory_path() /
      ("evo_report_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
       std::to_string(::getpid()));
};

/// 10 s along z at 10 m/s; the estimate is 2 % short and lacks the second from 4 s to 5 s.
inline evaluation::Evaluation SampleEvaluation() {
  geometry::Trajectory truth;
  geometry::Trajectory estimate;
  for (int i = 0; i <= 200; ++i) {
    const TimeNs t = i * (kNsPerSecond / 20);
    truth.push_back({t, geometry::SE3({1, 0, 0, 0}, {0, 0, 0.5 * i})});
    if (i <= 80 || i >= 100) estimate.push_back({t, geometry::SE3({1, 0, 0, 0}, {0, 0, 0.49 * i})});
  }
  return evaluation::Evaluate(truth, estimate, evaluation::ParseAlignments("none,origin"), {},
                              evaluation::EvaluationOptions());
}

}  // namespace evo::report
