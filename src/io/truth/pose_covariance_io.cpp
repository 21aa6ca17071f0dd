#include "evo/io/pose_covariance_io.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

#include "evo/core/error.hpp"
#include "evo/core/output_file.hpp"
#include "io/text_lines.hpp"
#include "io/truth/stamp_order.hpp"

namespace evo::io {

namespace {

/// The upper triangle, row by row.
std::string Header() {
  constexpr std::array kNames = {"x", "y", "z", "rx", "ry", "rz"};
  std::string header = "timestamp";
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    for (std::size_t j = i; j < kNames.size(); ++j) header += std::string(",") + kNames[i] + "_" + kNames[j];
  }
  return header;
}

}  // namespace

void WritePoseCovariances(const std::filesystem::path& path,
                          const std::vector<geometry::StampedCovariance>& covariances) {
  OutputFile file(path);
  file.stream() << Header() << '\n';
  for (const auto& [t, covariance] : covariances) {
    file.stream() << FormatTime(t);
    for (Eigen::Index i = 0; i < 6; ++i) {
      for (Eigen::Index j = i; j < 6; ++j) file.stream() << fmt::format(",{:.9g}", covariance(i, j));
    }
    file.stream() << '\n';
  }
  file.Commit();
}

std::vector<geometry::StampedCovariance> ReadPoseCovariances(const std::filesystem::path& path) {
  TextLines lines(path);
  std::string_view line;
  if (!lines.Next(&line) || line != Header()) {
    throw Error(ErrorKind::kInput, path.string() + ": expected a table that begins with the line '" + Header() +
                                       "'; give the pose_covariance.csv of a run");
  }
  std::vector<geometry::StampedCovariance> covariances;
  while (lines.Next(&line)) {
    const auto fields = SplitAtCommas(line);
    const auto t = ParseTime(fields[0]);
    if (!t) throw lines.Failure("the stamp " + Quote(fields[0]) + " is not a time in seconds");
    if (fields.size() != 22) throw lines.Failure("expected a stamp and 21 numbers, found " + Quote(line));
    if (!covariances.empty() && *t <= covariances.back().t)
      throw lines.Failure(UnorderedStampsMessage(covariances.back().t, *t));
    geometry::StampedCovariance row{*t, geometry::Matrix6d::Zero()};
    auto field = fields.begin() + 1;
    for (Eigen::Index i = 0; i < 6; ++i) {
      for (Eigen::Index j = i; j < 6; ++j, ++field) {
        const auto value = ParseFinite(*field);
        if (!value) throw lines.Failure(Quote(*field) + " is not a finite number");
        if (i == j && *value < 0.0) throw lines.Failure("the variance " + Quote(*field) + " is negative");
        row.covariance(i, j) = row.covariance(j, i) = *value;
      }
    }
    covariances.push_back(row);
  }
  if (covariances.empty()) throw Error(ErrorKind::kInput, path.string() + ": holds no covariances");
  return covariances;
}

}  // namespace evo::io
