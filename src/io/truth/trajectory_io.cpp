#include "evo/io/trajectory_io.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "evo/core/error.hpp"
#include "evo/core/format.hpp"
#include "evo/core/number.hpp"
#include "evo/core/output_file.hpp"
#include "evo/io/file_kind.hpp"
#include "io/hdf5/hdf5.hpp"
#include "io/text_lines.hpp"

namespace evo::io {

namespace {

constexpr double kUnitTolerance = 1e-3;  // files with five decimals are off by 1e-5
constexpr double kLargestSeconds = 9e9;
constexpr double kFarthest = 1e12;  // m; squares of it still leave digits for the errors
constexpr char kExpectedText[] = "a trajectory of lines 't px py pz qx qy qz qw'";

using RowMajor4d = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

std::string NotLater(TimeNs previous, TimeNs t) {
  return "the stamp " + FormatTime(t) + " s is not later than the one before, " + FormatTime(previous) +
         " s; sort the poses by time and drop repeated ones";
}

bool IsPlace(const Eigen::Vector3d& position) { return position.cwiseAbs().maxCoeff() <= kFarthest; }

/// Of the table of covariances.
std::string CovarianceHeader() {
  constexpr std::array kNames = {"x", "y", "z", "rx", "ry", "rz"};
  std::string header = "timestamp";
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    for (std::size_t j = i; j < kNames.size(); ++j) header += std::string(",") + kNames[i] + "_" + kNames[j];
  }
  return header;
}

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
  if (!IsPlace(position)) throw lines.Failure("the position is more than 1e12 m from the origin");
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

/// Empty if `T` is a rigid motion.
std::string RigidFault(const RowMajor4d& T) {
  if (!T.allFinite()) return "the pose is not finite";
  const Eigen::Matrix3d rotation = T.topLeftCorner<3, 3>();
  const double skew = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(skew < kUnitTolerance) || rotation.determinant() < 0.0) return "the pose's rotation is not orthonormal";
  if (!((T.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() < kUnitTolerance)) {
    return "the pose's last row is not 0 0 0 1";
  }
  if (!IsPlace(T.topRightCorner<3, 1>())) return "the position is more than 1e12 m from the origin";
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
    if (!(std::abs(seconds[i]) < kLargestSeconds)) {
      throw stamps.Failure(where + "the stamp " + FormatNumber(seconds[i]) + " is not a time");
    }
    const TimeNs t = FromSeconds(seconds[i]);
    if (i > 0 && t <= trajectory.back().t) throw stamps.Failure(where + NotLater(trajectory.back().t, t));
    const RowMajor4d T = Eigen::Map<const RowMajor4d>(&matrices[16 * i]);
    if (const std::string fault = RigidFault(T); !fault.empty()) throw poses.Failure(where + fault);
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
      throw lines.Failure(NotLater(trajectory.back().t, pose.t));
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
    if (const std::string fault = RigidFault(T); !fault.empty()) throw lines.Failure(fault);
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
  char numbers[512];  // seven doubles of any size would need more, poses of this universe do not
  for (const auto& [t, T] : trajectory) {
    const Eigen::Vector3d& p = T.translation();
    const Eigen::Quaterniond& q = T.rotation();
    if (!p.allFinite() || !q.coeffs().allFinite()) {
      throw Error(ErrorKind::kInput, path.string() + ": the pose at " + FormatTime(t) + " s is not finite");
    }
    std::snprintf(numbers, sizeof numbers, " %.12f %.12f %.12f %.12f %.12f %.12f %.12f\n", p.x(), p.y(), p.z(), q.x(),
                  q.y(), q.z(), q.w());
    file.stream() << FormatTime(t) << numbers;
  }
  file.Commit();
}

void WritePoseCovariances(const std::filesystem::path& path,
                          const std::vector<geometry::StampedCovariance>& covariances) {
  OutputFile file(path);
  file.stream() << CovarianceHeader() << '\n';
  for (const auto& [t, covariance] : covariances) {
    file.stream() << FormatTime(t);
    for (Eigen::Index i = 0; i < 6; ++i) {
      for (Eigen::Index j = i; j < 6; ++j) file.stream() << Format(",%.9g", covariance(i, j));
    }
    file.stream() << '\n';
  }
  file.Commit();
}

std::vector<geometry::StampedCovariance> ReadPoseCovariances(const std::filesystem::path& path) {
  TextLines lines(path);
  std::string_view line;
  if (!lines.Next(&line) || line != CovarianceHeader()) {
    throw Error(ErrorKind::kInput, path.string() + ": expected a table that begins with the line '" +
                                       CovarianceHeader() + "'; give the pose_covariance.csv of a run");
  }
  std::vector<geometry::StampedCovariance> covariances;
  while (lines.Next(&line)) {
    const auto fields = SplitAtCommas(line);
    const auto t = ParseTime(fields[0]);
    if (!t) throw lines.Failure("the stamp " + Quote(fields[0]) + " is not a time in seconds");
    if (fields.size() != 22) throw lines.Failure("expected a stamp and 21 numbers, found " + Quote(line));
    if (!covariances.empty() && *t <= covariances.back().t) throw lines.Failure(NotLater(covariances.back().t, *t));
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
