#include "evo/odometry/map_writer.hpp"

#include <fmt/format.h>

#include "evo/core/output_file.hpp"

namespace evo::odometry {

void WriteMap(const std::vector<Point>& points, const std::filesystem::path& path) {
  OutputFile file(path);
  auto& out = file.stream();
  out << fmt::format(
      "ply\nformat ascii 1.0\ncomment world coordinates of the trajectory beside this file\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\nproperty int track\nproperty int observations\n"
      "end_header\n",
      points.size());
  for (const Point& point : points) {
    const Eigen::Vector3d& p = point.position;
    out << fmt::format("{:.9g} {:.9g} {:.9g} {} {}\n", p.x(), p.y(), p.z(), point.track, point.inliers);
  }
  file.Commit();
}

}  // namespace evo::odometry
