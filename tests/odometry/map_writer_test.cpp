#include "evo/odometry/map_writer.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace evo::odometry {
namespace {

TEST(MapWriter, WritesPly) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "evo_map_writer_test";
  const auto path = folder / "map.ply";
  WriteMap({{7, {1.5, -2.0, 3.25}, 4, 0}}, path);
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text.substr(0, 4), "ply\n");
  EXPECT_NE(text.find("element vertex 1\n"), std::string::npos);
  EXPECT_NE(text.find("end_header\n1.5 -2 3.25 7 4\n"), std::string::npos) << text;
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace evo::odometry
