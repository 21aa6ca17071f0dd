#include "evo/io/pose_covariance_io.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/support.hpp"

namespace evo::io {
namespace {

using PoseCovarianceIoTest = IoTest;

TEST_F(PoseCovarianceIoTest, ReadsWhatItWrites) {
  std::vector<geometry::StampedCovariance> written;
  for (int k = 0; k < 3; ++k) {
    geometry::Matrix6d root = geometry::Matrix6d::Random();
    written.push_back({TimeNs{1'500'000'000} + k, root * root.transpose()});
  }
  WritePoseCovariances(folder / "pose_covariance.csv", written);
  const auto read = ReadPoseCovariances(folder / "pose_covariance.csv");
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t k = 0; k < read.size(); ++k) {
    EXPECT_EQ(read[k].t, written[k].t);
    EXPECT_LT((read[k].covariance - written[k].covariance).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST_F(PoseCovarianceIoTest, RefusesFaultyTables) {
  WritePoseCovariances(folder / "good.csv", {{TimeNs{1'000'000'000}, geometry::Matrix6d::Identity()}});
  std::ifstream file(folder / "good.csv");
  const std::string good{std::istreambuf_iterator<char>(file), {}};
  const std::string header = good.substr(0, good.find('\n') + 1);
  const std::string row = good.substr(header.size());
  const auto refusal = [&](const std::string& text) {
    const auto path = Write("bad.csv", text);
    return Refusal([&] { ReadPoseCovariances(path); });
  };
  for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
           {"", "expected a table"},
           {"1 2 3\n", "expected a table"},
           {header, "holds no covariances"},
           {header + "x" + row, "is not a time"},
           {header + row + row, ":3: the stamp"},
           {header + row.substr(0, row.rfind(',')) + "\n", ":2: expected a stamp and 21 numbers"},
           {header + row.substr(0, row.rfind(',')) + ",nan\n", "is not a finite number"},
           {header + row.substr(0, row.rfind(',')) + ",-1\n", "is negative"}}) {
    EXPECT_NE(refusal(text).find(part), std::string::npos) << refusal(text);
  }
}

}  // namespace
}  // namespace evo::io
