#include "evo/odometry/odometry.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>

#include "evo/core/error.hpp"
#include "evo/core/parameters.hpp"
#include "odometry/synthetic_drive.hpp"

namespace evo::odometry {
namespace {

using testing::Drive;
using testing::DriveCamera;
using testing::DriveOptions;
using testing::MakeDrive;

constexpr auto kNoProgress = [](OdometryStage, double) {};

struct Accuracy {
  double planar_percent = 0.0;    ///< mean planar error over the path: first pose aligned, one scale
  double rotation_degrees = 0.0;  ///< maximum error of the rotation since the first pose
  double coverage = 0.0;          ///< ratio of frames with a pose
};

Accuracy Evaluate(const geometry::Trajectory& estimate, const geometry::Trajectory& truth) {
  std::map<TimeNs, geometry::SE3> by_time;
  for (const auto& pose : truth) by_time[pose.t] = pose.T_world_cam;
  std::vector<geometry::SE3> a, b;  // relative to the first common pose
  for (const auto& pose : estimate) {
    a.push_back(estimate.front().T_world_cam.Inverse() * pose.T_world_cam);
    b.push_back(by_time.at(estimate.front().t).Inverse() * by_time.at(pose.t));
  }
  double ab = 0.0, aa = 0.0, path = 0.0;
  Accuracy accuracy;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += a[i].translation().dot(b[i].translation());
    aa += a[i].translation().squaredNorm();
    if (i > 0) path += (b[i].translation() - b[i - 1].translation()).norm();
    const double angle = geometry::so3::Log(a[i].rotation().conjugate() * b[i].rotation()).norm();
    accuracy.rotation_degrees = std::max(accuracy.rotation_degrees, angle * 180.0 / M_PI);
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector3d error = ab / aa * a[i].translation() - b[i].translation();
    accuracy.planar_percent += 100.0 * std::hypot(error.x(), error.z()) / path / static_cast<double>(a.size());
  }
  accuracy.coverage = static_cast<double>(estimate.size()) / static_cast<double>(truth.size());
  return accuracy;
}

OdometryResult Estimate(const Drive& drive, const OdometryOptions& options = {}, int threads = 2) {
  return RunOdometry(drive.tracks, DriveCamera(), options, threads, kNoProgress);
}

void ExpectEqual(const OdometryResult& a, const OdometryResult& b) {
  ASSERT_EQ(a.trajectory.size(), b.trajectory.size());
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    EXPECT_EQ(a.trajectory[i].t, b.trajectory[i].t);
    EXPECT_EQ(a.trajectory[i].T_world_cam.Matrix(), b.trajectory[i].T_world_cam.Matrix()) << i;
  }
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) EXPECT_EQ(a.points[i].position, b.points[i].position);
}

TEST(Odometry, TracksADriveWithBumpsStopAndTrafficWithinAPercent) {
  double sum = 0.0;
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const Drive drive = MakeDrive({.seed = seed});
    const auto result = Estimate(drive);
    const Accuracy accuracy = Evaluate(result.trajectory, drive.truth);
    EXPECT_LT(accuracy.planar_percent, 0.6) << seed;
    EXPECT_LT(accuracy.rotation_degrees, 1.2) << seed;
    EXPECT_EQ(accuracy.coverage, 1.0) << seed;
    EXPECT_EQ(result.bootstraps.size(), 1u) << seed;
    EXPECT_TRUE(result.lost.empty()) << seed;
    EXPECT_FALSE(result.resampled);
    EXPECT_GT(result.points.size(), 1000u) << seed;
    sum += accuracy.planar_percent;
  }
  EXPECT_LT(sum / 3, 0.35);
}

TEST(Odometry, RefinementLowersTheError) {
  OdometryOptions online;
  online.final_refinement.enabled = false;
  double before = 0.0, after = 0.0;
  for (std::uint32_t seed = 21; seed <= 24; ++seed) {
    const Drive drive = MakeDrive({.seconds = 8.0, .stop = false, .seed = seed});
    before += Evaluate(Estimate(drive, online).trajectory, drive.truth).planar_percent / 4;
    after += Evaluate(Estimate(drive).trajectory, drive.truth).planar_percent / 4;
  }
  EXPECT_LT(before, 1.0);
  EXPECT_LT(after, 0.3);
  EXPECT_LT(after, 0.8 * before);
}

TEST(Odometry, KeyFramesByRuleOrAtAFixedInterval) {
  const Drive drive = MakeDrive({.seconds = 4.0, .stop = false, .bumps = false});
  OdometryOptions options;
  options.frame_handler.key_frame.every_frames = 4;
  const auto regular = Estimate(drive, options);
  EXPECT_NEAR(regular.key_frames, regular.frames / 4, regular.frames / 16) << "fewer while the first map is made";
  EXPECT_NE(Estimate(drive).key_frames, regular.key_frames);
}

TEST(Odometry, ResultDoesNotDependOnThreads) {
  const Drive drive = MakeDrive({.seconds = 5.0, .seed = 5});
  ExpectEqual(Estimate(drive, {}, 1), Estimate(drive, {}, 4));
}

TEST(Odometry, ANewSegmentAfterAGapContinuesTheVelocity) {
  const Drive drive = MakeDrive({.stop = false, .blackout = FromSeconds(0.5), .seed = 6});
  const auto result = Estimate(drive);
  EXPECT_EQ(result.bootstraps.size(), 2u);
  ASSERT_EQ(result.losses.size(), 1u);
  EXPECT_GE(result.losses.front().features, result.losses.front().map_points);
  EXPECT_GE(result.losses.front().map_points, result.losses.front().inliers);
  EXPECT_LE(result.losses.front().t, result.bootstraps.back());
  const Accuracy accuracy = Evaluate(result.trajectory, drive.truth);
  EXPECT_LT(accuracy.planar_percent, 3.0);  // only the speed carries the scale over
  EXPECT_GT(accuracy.coverage, 0.93);
  for (std::size_t i = 1; i < result.trajectory.size(); ++i) {
    EXPECT_GT(result.trajectory[i].t, result.trajectory[i - 1].t);
  }
}

/// Too few tracks to start a map in the first three seconds, enough to be tracked backwards from a later one.
TEST(Odometry, TracksBackwardsFromTheFirstMap) {
  Drive drive = MakeDrive({.features = 150, .stop = false, .seed = 2});
  const TimeNs rich = drive.truth.front().t + FromSeconds(3.0);
  std::erase_if(drive.tracks, [&](const auto& o) { return o.t < rich && o.id % 3 != 0; });
  OdometryOptions options;
  options.frame_handler.bootstrap.min_inliers = 60;
  const auto result = Estimate(drive, options);
  const Accuracy accuracy = Evaluate(result.trajectory, drive.truth);
  ASSERT_EQ(result.bootstraps.size(), 1u);
  EXPECT_GT(result.bootstraps.front(), drive.truth.front().t + FromSeconds(2.0));
  EXPECT_GT(accuracy.coverage, 0.97);
  EXPECT_LT(accuracy.planar_percent, 1.0);
  EXPECT_LT(accuracy.rotation_degrees, 1.2);
  ExpectEqual(Estimate(drive, options, 1), result);
  options.backward_tracking = false;
  EXPECT_LT(Evaluate(Estimate(drive, options).trajectory, drive.truth).coverage, 0.8);
}

TEST(Odometry, RejectsAStandingCamera) {
  const Drive drive = MakeDrive({.seconds = 3.0, .speed = 0.0, .bumps = false});
  try {
    Estimate(drive);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kTrackingLost);
    EXPECT_NE(std::string(error.what()).find("too little motion"), std::string::npos) << error.what();
  }
}

TEST(Odometry, FewStaticPointsSufficeAtAStop) {
  Drive drive = MakeDrive({.seed = 7});
  // During the stop most tracks lie on cars that drive off.
  const TimeNs begin = drive.truth.front().t + FromSeconds(5.8), end = begin + FromSeconds(0.5);
  for (auto& o : drive.tracks) {
    if (o.t < begin || o.id % 50 >= 31) continue;
    if (o.t <= end) {
      o.x += (o.id % 2 ? 150.0 : -90.0) * ToSeconds(o.t - begin);
    } else {
      o.id += 1000000;  // another feature, behind the car
    }
  }
  std::ranges::stable_sort(drive.tracks, {}, [](const auto& o) { return std::pair(o.t, o.id); });
  const auto result = Estimate(drive);
  EXPECT_EQ(result.bootstraps.size(), 1u);
  const Accuracy accuracy = Evaluate(result.trajectory, drive.truth);
  EXPECT_EQ(accuracy.coverage, 1.0);
  EXPECT_LT(accuracy.planar_percent, 0.6);
  EXPECT_LT(accuracy.rotation_degrees, 1.2);
}

TEST(Odometry, ReportsTooFewTracks) {
  const Drive drive = MakeDrive({.seconds = 3.0, .features = 10, .stop = false});
  try {
    Estimate(drive);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kTrackingLost);
    EXPECT_NE(std::string(error.what()).find("tracks"), std::string::npos) << error.what();
  }
}

TEST(Odometry, RejectsACalibrationOfAnotherSensor) {
  geometry::Calibration small = DriveCamera().calibration();
  small.width = 240;
  small.height = 180;
  try {
    RunOdometry(MakeDrive({.seconds = 1.0}).tracks, geometry::Camera(small), {}, 1, kNoProgress);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_NE(std::string(error.what()).find("240 x 180"), std::string::npos) << error.what();
  }
}

TEST(OdometryOptions, FormerNamesAreAccepted) {
  OdometryOptions options;
  Parameters parameters;
  Register(parameters, options);
  parameters.Set("odometry.final.drift=0.5");
  parameters.Set("odometry.final.motion=3");
  parameters.Set("odometry.final.own_noise=false");
  parameters.Set("odometry.final.budget=5e3");
  parameters.Set("odometry.covariance.alike=7");
  parameters.Set("odometry.covariance.turn=0.25");
  parameters.Set("odometry.ground.drift=0.125");
  EXPECT_EQ(options.final_refinement.drift_variance_ratio, 0.5);
  EXPECT_EQ(options.final_refinement.velocity_change_scale, 3.0);
  EXPECT_FALSE(options.final_refinement.track_noise);
  EXPECT_EQ(options.final_refinement.max_block_products, 5e3);
  EXPECT_EQ(options.final_refinement.covariance.variance_inflation, 7.0);
  EXPECT_EQ(options.final_refinement.covariance.rotation_bias_ratio, 0.25);
  EXPECT_EQ(options.ground.scale_drift_ratio, 0.125);
}

TEST(OdometryOptions, HaveUniqueNamesAndDefaultsInRange) {
  OdometryOptions options;
  Parameters parameters;
  Register(parameters, options);
  std::map<std::string, int> names;
  for (const auto& [name, value] : parameters.Values()) {
    EXPECT_EQ(++names[name], 1) << name;
    EXPECT_EQ(name.rfind("odometry.", 0), 0u) << name;
    EXPECT_NO_THROW(parameters.Set(name + "=" + value)) << name;
  }
}

/// Real asynchronous tracks with motion capture as truth.
TEST(Odometry, TracksRealAsynchronousTracks) {
  const std::string folder = std::string(EVO_SOURCE_DIR) + "/../shared/data/uzh_boxes_6dof_tracks/";
  std::ifstream calibration_file(folder + "calib.txt"), tracks_file(folder + "tracks.txt");
  std::ifstream truth_file(folder + "groundtruth.txt");
  if (!calibration_file || !tracks_file || !truth_file) GTEST_SKIP() << folder << " is not here";
  geometry::Calibration calibration;
  calibration.width = 240;
  calibration.height = 180;
  calibration_file >> calibration.fx >> calibration.fy >> calibration.cx >> calibration.cy;
  for (double& k : calibration.coefficients) calibration_file >> k;
  events::Tracks tracks;
  std::string stamp;
  for (events::TrackObservation o; tracks_file >> o.id >> stamp >> o.x >> o.y;) {
    o.t = ParseTime(stamp).value();
    tracks.push_back(o);
  }
  std::ranges::sort(tracks, {}, [](const events::TrackObservation& o) { return std::pair(o.t, o.id); });
  const auto result = RunOdometry(tracks, geometry::Camera(calibration), {}, 2, kNoProgress);
  EXPECT_TRUE(result.resampled);
  ASSERT_GT(result.trajectory.size(), 140u);

  std::map<TimeNs, Eigen::Vector3d> truth;
  for (std::string line; std::getline(truth_file, line);) {
    std::istringstream row(line);
    Eigen::Vector3d p;
    if (line[0] != '#' && row >> stamp >> p.x() >> p.y() >> p.z()) truth[ParseTime(stamp).value()] = p;
  }
  Eigen::Matrix3Xd a(3, 0), b(3, 0);
  for (const auto& pose : result.trajectory) {
    const auto after = truth.upper_bound(pose.t);
    if (after == truth.begin() || after == truth.end()) continue;
    const auto before = std::prev(after);
    const double s = ToSeconds(pose.t - before->first) / ToSeconds(after->first - before->first);
    a.conservativeResize(3, a.cols() + 1);
    b.conservativeResize(3, b.cols() + 1);
    a.rightCols<1>() = pose.T_world_cam.translation();
    b.rightCols<1>() = (1.0 - s) * before->second + s * after->second;
  }
  const Eigen::Matrix4d similarity = Eigen::umeyama(a, b);
  const Eigen::Matrix3Xd errors =
      ((similarity.topLeftCorner<3, 3>() * a).colwise() + similarity.topRightCorner<3, 1>()) - b;
  EXPECT_LT(std::sqrt(errors.colwise().squaredNorm().mean()), 0.025);  // m, over a path of 1.4 m
}

}  // namespace
}  // namespace evo::odometry
