#include "odometry/scale/ground_scale.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "evo/odometry/odometry.hpp"
#include "odometry/synthetic_drive.hpp"
#include "odometry/synthetic_street.hpp"

namespace evo::odometry {
namespace {

using testing::kStreetCameraHeightM;
using testing::Street;
using testing::StreetSimulator;

GroundScale Scale(Street* street) {
  return ScaleByGround({.camera_height_m = kStreetCameraHeightM}, street->frames, &street->segments);
}

std::vector<Eigen::Vector3d> Positions(const Street& street) {
  std::vector<Eigen::Vector3d> positions;
  for (const Segment& segment : street.segments) {
    for (const SegmentPose& pose : segment.poses) positions.push_back(pose.T_cam_world.Inverse().translation());
  }
  return positions;
}

/// Estimated over true path length between two frames, minus one.
double ScaleError(const Street& street, std::size_t from, std::size_t to) {
  const auto positions = Positions(street);
  double estimated = 0.0, truth = 0.0;
  for (std::size_t i = from + 1; i <= to; ++i) {
    estimated += (positions[i] - positions[i - 1]).norm();
    truth += (street.T_cam_world[i].Inverse().translation() - street.T_cam_world[i - 1].Inverse().translation()).norm();
  }
  return estimated / truth - 1.0;
}

/// The whole path within 0.5 %, and parts of it within `max_local_error`.
void ExpectMetric(const Street& street, double max_local_error = 0.01) {
  const std::size_t last = street.frames.size() - 1;
  EXPECT_NEAR(ScaleError(street, 0, last), 0.0, 0.005);
  for (std::size_t i = 0; i + 200 <= last; i += 100)
    EXPECT_NEAR(ScaleError(street, i, i + 200), 0.0, max_local_error) << i;
}

TEST(GroundScale, MeasuresTheScaleAndItsDrift) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Street street = StreetSimulator({.seed = seed}).Simulate();
    EXPECT_GT(std::abs(ScaleError(street, 0, 999)), 0.4);
    const GroundScale scale = Scale(&street);
    EXPECT_TRUE(scale.found);
    EXPECT_GT(scale.tracks, 300u);
    EXPECT_GT(scale.covered_ratio, 0.99);
    EXPECT_LT(scale.relative_sigma, 0.005);
    EXPECT_NEAR(scale.min_scale, 1.94, 0.02);
    EXPECT_NEAR(scale.max_scale, 2.06, 0.02);
    ExpectMetric(street);
  }
}

TEST(GroundScale, MovesPointsWithTheirObservingPoses) {
  Street street = StreetSimulator({}).Simulate();
  const Street before = street;
  Scale(&street);
  ASSERT_EQ(street.segments[0].points.size(), before.segments[0].points.size());
  for (std::size_t i = 0; i < street.segments[0].points.size(); ++i) {
    const Point& point = street.segments[0].points[i];
    const int frame = street.first_frames.at(point.track);
    const Eigen::Vector3d seen = before.segments[0].poses[frame].T_cam_world * before.segments[0].points[i].position;
    const Eigen::Vector3d moved = street.segments[0].poses[frame].T_cam_world * point.position;
    EXPECT_LT((moved - street.scale[frame] * seen).norm(), 0.02 * moved.norm()) << i;
  }
}

TEST(GroundScale, KeepsRotationsAndTheFirstPose) {
  Street street = StreetSimulator({.frames = 300, .curvature = 0.002}).Simulate();
  const std::vector<geometry::Matrix6d> unit_covariances(street.frames.size(), geometry::Matrix6d::Identity());
  street.segments[0].uncertainty =
      SegmentUncertainty(PoseErrorSamples({street.segments[0].poses[0].T_cam_world}, 1), {0}, unit_covariances);
  const Street before = street;
  ASSERT_TRUE(Scale(&street).found);
  const auto covariances = street.segments[0].uncertainty.Covariances(false);
  EXPECT_NEAR(covariances[100](1, 1), std::pow(street.scale[100], 2), 0.1);
  EXPECT_EQ(covariances[100](4, 4), 1.0);
  EXPECT_NEAR(street.segments[0].poses.front().T_cam_world.translation().norm(), 0.0, 1e-9);
  for (std::size_t i = 0; i < street.frames.size(); ++i) {
    const auto& pose = street.segments[0].poses[i].T_cam_world;
    EXPECT_LT(pose.rotation().angularDistance(before.segments[0].poses[i].T_cam_world.rotation()), 1e-9);
  }
}

TEST(GroundScale, AllowsPitchAndRoll) {
  for (const double pitch : {-0.15, 0.2, 0.4}) {
    Street street = StreetSimulator({.pitch = pitch, .roll = 0.05}).Simulate();
    EXPECT_TRUE(Scale(&street).found) << pitch;
    ExpectMetric(street);
  }
}

TEST(GroundScale, AllowsHillsAndCurves) {
  Street street = StreetSimulator({.curvature = 0.004, .hills = 0.06}).Simulate();
  EXPECT_TRUE(Scale(&street).found);
  ExpectMetric(street, 0.015);
}

TEST(GroundScale, AllowsACarToRockOnItsSprings) {
  Street street = StreetSimulator({.heave = 0.015}).Simulate();
  EXPECT_TRUE(Scale(&street).found);
  ExpectMetric(street, 0.015);
}

TEST(GroundScale, HoldsTheScaleWithoutTexture) {
  Street street = StreetSimulator({.bare_from_m = 60, .bare_to_m = 90}).Simulate();
  const GroundScale scale = Scale(&street);
  EXPECT_TRUE(scale.found);
  ExpectMetric(street, 0.02);
}

TEST(GroundScale, EstimatesAScaleForEverySegment) {
  Street street = StreetSimulator({.lost_at_m = 90}).Simulate();
  ASSERT_EQ(street.segments.size(), 2u);
  const GroundScale scale = Scale(&street);
  EXPECT_TRUE(scale.found);
  EXPECT_GT(scale.max_scale, 2.5);
  EXPECT_NEAR(ScaleError(street, 0, 500), 0.0, 0.01);
  EXPECT_NEAR(ScaleError(street, 620, 999), 0.0, 0.01);
}

TEST(GroundScale, HoldsAnUnknownHeight) {
  for (const bool lost : {false, true}) {
    Street street = StreetSimulator({.lost_at_m = lost ? 90 : 1e9}).Simulate();
    const GroundScale scale = ScaleByGround({}, street.frames, &street.segments);
    EXPECT_TRUE(scale.found);
    EXPECT_FALSE(scale.metric);
    const double unit = 1.0 + ScaleError(street, 0, 999);
    EXPECT_NEAR(unit, 1.0 / (lost ? 2.3 : 2.0), lost ? 0.1 : 0.02);
    for (std::size_t i = 0; i + 200 <= 999; i += 100) {
      EXPECT_NEAR((1.0 + ScaleError(street, i, i + 200)) / unit, 1.0, 0.01) << i;
    }
  }
}

TEST(GroundScale, FindsARoadWithFewTracks) {
  for (const double tracks_hz : {5.0, 8.0, 20.0}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      Street street = StreetSimulator({.road_tracks_hz = tracks_hz, .seed = seed}).Simulate();
      const GroundScale scale = Scale(&street);
      EXPECT_TRUE(scale.found) << tracks_hz;
      EXPECT_NEAR(ScaleError(street, 0, 999), 0.0, std::min(0.01, 4.0 * scale.relative_sigma)) << tracks_hz;
    }
  }
}

TEST(GroundScale, IsTheLessSureTheFewerTracksThereAre) {
  Street few = StreetSimulator({.road_tracks_hz = 5}).Simulate();
  Street many = StreetSimulator({.road_tracks_hz = 20}).Simulate();
  EXPECT_GT(Scale(&few).relative_sigma, 1.1 * Scale(&many).relative_sigma);
}

TEST(GroundScale, TakesTheRoadAndNotThePavement) {
  for (const double tracks_hz : {8.0, 20.0, 0.0}) {
    Street street = StreetSimulator({.road_tracks_hz = tracks_hz, .pavement_m = 0.15}).Simulate();
    EXPECT_TRUE(Scale(&street).found) << tracks_hz;
    EXPECT_NEAR(ScaleError(street, 0, 999), 0.0, 0.015) << tracks_hz;  // the pavement would make it 0.1
  }
}

TEST(GroundScale, FindsFewTracksOnHills) {
  Street street = StreetSimulator({.curvature = 0.004, .hills = 0.06, .road_tracks_hz = 10}).Simulate();
  EXPECT_TRUE(Scale(&street).found);
  EXPECT_NEAR(ScaleError(street, 0, 999), 0.0, 0.015);
}

void ExpectUnchanged(const GroundOptions& options, Street street) {
  const Street before = street;
  EXPECT_FALSE(ScaleByGround(options, street.frames, &street.segments).found);
  for (std::size_t i = 0; i < street.frames.size(); ++i) {
    EXPECT_EQ(street.segments[0].poses[i].T_cam_world.Matrix(), before.segments[0].poses[i].T_cam_world.Matrix());
  }
  for (std::size_t i = 0; i < street.segments[0].points.size(); ++i) {
    EXPECT_EQ(street.segments[0].points[i].position, before.segments[0].points[i].position);
  }
}

TEST(GroundScale, ChangesNothingWithoutGround) {
  ExpectUnchanged({}, StreetSimulator({.road = false}).Simulate());
  ExpectUnchanged({.camera_height_m = kStreetCameraHeightM}, StreetSimulator({.road = false}).Simulate());
}

TEST(GroundScale, ClaimsNoScaleAmongWallsAndMovingObjects) {
  for (unsigned seed = 2; seed <= 6; ++seed) {
    ExpectUnchanged({}, StreetSimulator({.outliers = 0.3, .road = false, .seed = seed}).Simulate());
  }
}

/// A plane on a few metres may be the bonnet of a car.
TEST(GroundScale, ChangesNothingForAPlaneOnAFewMetres) {
  ExpectUnchanged({}, StreetSimulator({.bare_from_m = 12, .bare_to_m = 1e9}).Simulate());
  ExpectUnchanged({.camera_height_m = kStreetCameraHeightM},
                  StreetSimulator({.bare_from_m = 12, .bare_to_m = 1e9}).Simulate());
}

TEST(GroundScale, ChangesNothingIfTheHeightIsNotConstant) {
  for (const double height_m : {0.0, kStreetCameraHeightM}) {
    ExpectUnchanged({.camera_height_m = height_m}, StreetSimulator({.heave = 0.15}).Simulate());
    ExpectUnchanged({.camera_height_m = height_m}, StreetSimulator({.climb = 1.0}).Simulate());
  }
}

TEST(GroundScale, ChangesNothingOnAShortPathWithUnknownHeight) {
  ExpectUnchanged({}, StreetSimulator({.frames = 80}).Simulate());
}

TEST(GroundScale, ChangesNothingWithoutFrames) {
  std::vector<Segment> none(1);
  EXPECT_FALSE(ScaleByGround({.camera_height_m = kStreetCameraHeightM}, {}, &none).found);
  Street street = StreetSimulator({.frames = 2}).Simulate();
  EXPECT_FALSE(Scale(&street).found);
}

/// The whole odometry: the trajectory comes out in metres.
TEST(GroundScale, MakesADriveMetric) {
  const auto drive = testing::MakeDrive({.features = 200, .seed = 3});
  OdometryOptions options;
  const auto run = [&] {
    return RunOdometry(drive.tracks, testing::DriveCamera(), options, 2, [](OdometryStage, double) {});
  };
  options.ground.hold_height = false;
  EXPECT_FALSE(run().ground.has_value());
  options.ground.camera_height_m = kStreetCameraHeightM;
  const OdometryResult result = run();
  ASSERT_TRUE(result.ground && result.ground->found && result.ground->metric);
  std::map<TimeNs, Eigen::Vector3d> truth;
  for (const auto& pose : drive.truth) truth[pose.t] = pose.T_world_cam.translation();
  const auto& first = result.trajectory.front();
  const auto& last = result.trajectory.back();
  const double distance = (last.T_world_cam.translation() - first.T_world_cam.translation()).norm();
  EXPECT_NEAR(distance / (truth.at(last.t) - truth.at(first.t)).norm(), 1.0, 0.01);
}

}  // namespace
}  // namespace evo::odometry
