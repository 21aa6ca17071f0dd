#include "evo/io/trajectory_io.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "evo/core/error.hpp"
#include "evo/core/number.hpp"
#include "evo/core/output_file.hpp"
#include "evo/io/file_kind.hpp"
#include "io/hdf5/hdf5.hpp"
#include "io/text_lines.hpp"
#include "io/truth/stamp_order.hpp"

namespace evo::io {

namespace {

constexpr double kUnitTolerance = 1e-3;  // files with five decimals are off by 1e-5
constexpr double kMaxSeconds = 9e9;      // int64 holds 9.2e9 s in nanoseconds
constexpr double kMaxCoordinate = 1e12;  // m; squares of it still leave digits for the errors
constexpr char kExpectedText[] = "a trajectory of lines 't px py pz qx qy qz qw'";

using RowMajor4d = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

bool IsInRange(const Eigen::Vector3d& position) { return position.cwiseAbs().maxCoeff() <= kMaxCoordinate; }

geometry::StampedPose ParsePose(const TextLines& lines, std::string_view line) {
  const auto fields = SplitFields(line);
  if (fields.size() != 8) throw lines.Failure("expected 't px py pz qx qy qz qw', found " + Quote(line));
  const auto t = ParseTime(fields[0]);
  if (!t) throw lines.Failure("the stamp " + Quote(fields[0]) + " is not a time in seconds");
  std::array<double, 7> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto value = ParseFinite(fields[i + 1]);
    if (!value) throw lines.Failure(Quote(fields[i + 1]) + " is not a finite number");
    v[i] = *value;
  }
  const Eigen::Vector3d position(v[0], v[1], v[2]);
  if (!IsInRange(position)) throw lines.Failure("the position is more than 1e12 m from the origin");
  const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
  if (!(std::abs(rotation.norm() - 1.0) < kUnitTolerance)) {
    throw lines.Failure("the quaternion has the norm " + FormatNumber(rotation.norm()) +
                        ", not 1; expected 't px py pz qx qy qz qw'");
  }
  return {*t, {rotation, position}};
}

geometry::SE3 ToPose(const RowMajor4d& T) {
  const Eigen::Matrix3d rotation = T.topLeftCorner<3, 3>();
  return {Eigen::Quaterniond(rotation), T.topRightCorner<3, 1>()};
}

/// The fault of a matrix that is no rigid motion; empty for one that is.
std::string RigidityFault(const RowMajor4d& T) {
  if (!T.allFinite()) return "the pose is not finite";
  const Eigen::Matrix3d rotation = T.topLeftCorner<3, 3>();
  const double skew = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(skew < kUnitTolerance) || rotation.determinant() < 0.0) return "the pose's rotation is not orthonormal";
  if (!((T.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() < kUnitTolerance)) {
    return "the pose's last row is not 0 0 0 1";
  }
  if (!IsInRange(T.topRightCorner<3, 1>())) return "the position is more than 1e12 m from the origin";
  return "";
}

geometry::Trajectory ReadMvsec(const std::filesystem::path& path, GroundTruthSource source) {
  const hdf5::File file(path);
  const std::string name = source == GroundTruthSource::kLoam ? "davis/left/odometry" : "davis/left/pose";
  const hdf5::Dataset poses = file.Open(name);
  const hdf5::Dataset stamps = file.Open(name + "_ts");
  const auto& shape = poses.shape();
  if (shape.size() != 3 || shape[1] != 4 || shape[2] != 4) throw poses.Failure(" is not N x 4 x 4");
  if (stamps.shape() != std::vector<hsize_t>{shape[0]}) {
    throw stamps.Failure(" has not one stamp for each of the " + std::to_string(shape[0]) + " poses");
  }
  if (shape[0] == 0) throw poses.Failure(" holds no poses");
  std::vector<double> seconds(shape[0]);
  std::vector<double> matrices(16 * shape[0]);
  stamps.Read(0, shape[0], seconds.data());
  poses.Read(0, shape[0], matrices.data());

  geometry::Trajectory trajectory;
  trajectory.reserve(shape[0]);
  for (std::size_t i = 0; i < shape[0]; ++i) {
    const std::string where = " row " + std::to_string(i) + ": ";
    if (!(std::abs(seconds[i]) < kMaxSeconds)) {
      throw stamps.Failure(where + "the stamp " + FormatNumber(seconds[i]) + " is not a time");
    }
    const TimeNs t = FromSeconds(seconds[i]);
    if (i > 0 && t <= trajectory.back().t) throw stamps.Failure(where + UnorderedStampsMessage(trajectory.back().t, t));
    const RowMajor4d T = Eigen::Map<const RowMajor4d>(&matrices[16 * i]);
    if (const std::string fault = RigidityFault(T); !fault.empty()) throw poses.Failure(where + fault);
    trajectory.push_back({t, ToPose(T)});
  }
  return trajectory;
}

geometry::Trajectory ReadText(const std::filesystem::path& path) {
  TextLines lines(path);
  geometry::Trajectory trajectory;
  std::string_view line;
  while (lines.Next(&line)) {
    const geometry::StampedPose pose = ParsePose(lines, line);
    if (!trajectory.empty() && pose.t <= trajectory.back().t) {
      throw lines.Failure(UnorderedStampsMessage(trajectory.back().t, pose.t));
    }
    trajectory.push_back(pose);
  }
  if (trajectory.empty()) throw Error(ErrorKind::kInput, path.string() + ": no poses; expected " + kExpectedText);
  return trajectory;
}

}  // namespace

geometry::Trajectory ReadTum(const std::filesystem::path& path) {
  RequireKind(path, {FileKind::kTrajectoryText}, kExpectedText);
  return ReadText(path);
}

geometry::Trajectory ReadKitti(const std::filesystem::path& path) {
  RequireKind(path, {FileKind::kKittiPoses}, "a pose file of rows of 12 numbers (KITTI)");
  TextLines lines(path);
  geometry::Trajectory trajectory;
  std::string_view line;
  while (lines.Next(&line)) {
    const auto fields = SplitFields(line);
    if (fields.size() != 12) {
      throw lines.Failure("expected the 12 numbers of a KITTI pose, found " + std::to_string(fields.size()) + ": " +
                          Quote(line));
    }
    RowMajor4d T = RowMajor4d::Identity();
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const auto value = ParseFinite(fields[i]);
      if (!value) throw lines.Failure(Quote(fields[i]) + " is not a finite number");
      T.data()[i] = *value;
    }
    if (const std::string fault = RigidityFault(T); !fault.empty()) throw lines.Failure(fault);
    trajectory.push_back({static_cast<TimeNs>(trajectory.size()) * kNsPerSecond, ToPose(T)});
  }
  if (trajectory.empty()) throw Error(ErrorKind::kInput, path.string() + ": no poses; expected rows of 12 numbers");
  return trajectory;
}

geometry::Trajectory ReadGroundTruth(const std::filesystem::path& path, GroundTruthSource source) {
  RequireKind(path, {FileKind::kTrajectoryText, FileKind::kHdf5},
              "an MVSEC _gt.hdf5 or a trajectory of lines 't px py pz qx qy qz qw'");
  return DetectKind(path) == FileKind::kHdf5 ? ReadMvsec(path, source) : ReadText(path);
}

void WriteTum(const std::filesystem::path& path, const geometry::Trajectory& trajectory) {
  OutputFile file(path);
  for (const auto& [t, T] : trajectory) {
    const Eigen::Vector3d& p = T.translation();
    const Eigen::Quaterniond& q = T.rotation();
    if (!p.allFinite() || !q.coeffs().allFinite()) {
      throw Error(ErrorKind::kInput, path.string() + ": the pose at " + FormatTime(t) + " s is not finite");
    }
    file.stream() << fmt::format("{} {:.12f} {:.12f} {:.12f} {:.12f} {:.12f} {:.12f} {:.12f}\n", FormatTime(t), p.x(),
                                 p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  file.Commit();
}

}  // namespace evo::io
