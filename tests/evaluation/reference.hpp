#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo {

inline std::filesystem::path ReferencePath(const std::string& name) {
  return std::filesystem::path(EVO_SOURCE_DIR) / "tests/evaluation/data" / name;
}

inline Trajectory ReadReferenceTrajectory(const std::string& name) {
  std::ifstream file(ReferencePath(name));
  Trajectory trajectory;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream fields(line);
    std::string stamp;
    Eigen::Vector3d p;
    Eigen::Quaterniond q;
    fields >> stamp >> p.x() >> p.y() >> p.z() >> q.x() >> q.y() >> q.z() >> q.w();
    trajectory.push_back({ParseTime(stamp).value(), SE3(q, p)});
  }
  return trajectory;
}

/// The rows of a CSV file, each by column name.
inline std::vector<std::map<std::string, std::string>> ReadReferenceTable(const std::string& name) {
  std::ifstream file(ReferencePath(name));
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(file, line);
  const auto header = split(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(file, line)) {
    const auto cells = split(line);
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < header.size() && i < cells.size(); ++i) row[header[i]] = cells[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace evo
