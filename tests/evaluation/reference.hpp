#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "evo/io/trajectory_io.hpp"

namespace evo::evaluation {

inline std::filesystem::path ReferencePath(const std::string& name) {
  return std::filesystem::path(EVO_SOURCE_DIR) / "tests/evaluation/data" / name;
}

inline geometry::Trajectory ReadReferenceTrajectory(const std::string& name) {
  return io::ReadTum(ReferencePath(name));
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

}  // namespace evo::evaluation
