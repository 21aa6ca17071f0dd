#include "evo/odometry/map_writer.hpp"

#include <iomanip>

#include "evo/core/output_file.hpp"

namespace evo::odometry {

void WriteMap(const std::vector<Point>& points, const std::filesystem::path& path) {
  OutputFile file(path);
  auto& out = file.stream();
  out << "ply\nformat ascii 1.0\ncomment world coordinates of the trajectory beside this file\n"
      << "element vertex " << points.size() << "\nproperty double x\nproperty double y\nproperty double z\n"
      << "property int track\nproperty int observations\nend_header\n"
      << std::setprecision(9);
  for (const Point& point : points) {
    out << point.position.x() << ' ' << point.position.y() << ' ' << point.position.z() << ' ' << point.track << ' '
        << point.inliers << '\n';
  }
  file.Commit();
}

}  // namespace evo::odometry
