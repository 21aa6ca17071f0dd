#include "odometry/scale/ground_scale.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>

#include "evo/odometry/odometry.hpp"
#include "odometry/synthetic_drive.hpp"

namespace evo::odometry {
namespace {

constexpr double kHeight = 1.5;   // m, of the camera above the road
constexpr double kStep = 0.16;    // m from frame to frame
constexpr double kFocalPx = 226;  // turns the noise into units of the plane z = 1

struct StreetOptions {
  int frames = 1000;
  int features = 150;
  double noise_px = 0.3;
  double outliers = 0.1;     ///< share of the tracks that move by themselves
  double pitch = 0.0;        ///< of the camera against the car, rad; positive looks down
  double roll = 0.0;         ///< the same, rad
  double bend = 0.0;         ///< heading's change over a metre, rad, to and fro
  double hills = 0.0;        ///< steepest slope
  double bare_from_m = 1e9;  ///< from here
  double bare_to_m = 0.0;    ///< to here the road has no texture
  bool road = true;          ///< else nothing but walls
  double heave = 0.0;        ///< of the camera's height, relative, to and fro within 10 m: carried, not driven
  double climb = 0.0;        ///< the same, within the second half of the way: an aircraft
  double lost_at_m = 1e9;    ///< the tracking starts anew, with another scale
  unsigned seed = 1;
};

/// What the odometry would have made of a drive: all frames, and the poses with a scale that drifts.
struct Street {
  std::vector<Frame> frames;
  std::vector<geometry::SE3> T_cam_world;  ///< true, m
  std::vector<double> scale;               ///< true metres a unit, at every frame
  std::vector<Segment> segments;           ///< as estimated
  std::map<std::int64_t, int> born_at;     ///< frame, of the points of the segments' maps
};

class StreetMaker {
 public:
  explicit StreetMaker(const StreetOptions& options) : options_(options), random_(options.seed) {}

  Street Make() {
    for (int i = 0; i < options_.frames; ++i) {
      street_.T_cam_world.push_back(Pose(i).Inverse());
      street_.frames.push_back({i * FromSeconds(0.02), {}, {}});
      Move();
      while (static_cast<int>(live_.size()) < options_.features) Add();
      Observe();
    }
    Estimate();
    return std::move(street_);
  }

 private:
  struct Live {
    std::int64_t id;
    Eigen::Vector3d position, velocity;  // world, a frame
    int dies;                            // frame
  };

  double RoadHeight(double z) const { return options_.hills / 0.05 * (1.0 - std::cos(0.05 * z)); }  // downwards

  double CameraHeight(double z) const {
    const double half = 0.5 * options_.frames * kStep;
    return kHeight * (1.0 + options_.heave * std::sin(0.6 * z) + options_.climb * std::max(0.0, z / half - 1.0));
  }

  /// T_world_cam: parallel to the road, then the camera on the car.
  geometry::SE3 Pose(int frame) const {
    const double z = frame * kStep;
    const double slope = options_.hills * std::sin(0.05 * z);
    const double x = options_.bend / 0.0016 * (1.0 - std::cos(0.04 * z));
    const double heading = std::atan(options_.bend / 0.04 * std::sin(0.04 * z));
    const Eigen::Quaterniond car = geometry::so3::Exp({0, heading, 0}) * geometry::so3::Exp({-std::atan(slope), 0, 0});
    const Eigen::Quaterniond camera =
        geometry::so3::Exp({-options_.pitch, 0, 0}) * geometry::so3::Exp({0, 0, options_.roll});
    return {car * camera, Eigen::Vector3d(x, RoadHeight(z), z) + car * Eigen::Vector3d(0, -CameraHeight(z), 0)};
  }

  /// Where a ray from the camera meets the road or a wall, up to 40 m away.
  std::optional<Eigen::Vector3d> Meet(const geometry::SE3& T_world_cam, const Eigen::Vector2d& x) {
    const double wall = 5.0 + 5.0 * Uniform();
    const Eigen::Vector3d from = T_world_cam.translation();
    const Eigen::Vector3d ray = T_world_cam.rotation() * x.homogeneous();
    const auto above = [&](double depth) { return RoadHeight((from + depth * ray).z()) - (from + depth * ray).y(); };
    constexpr double kStride = 0.1;
    for (double depth = 2.0; depth < 40.0; depth += kStride) {
      if (above(depth) < 0.0) {
        const double before = above(depth - kStride);
        const Eigen::Vector3d at = from + (depth - kStride * (1.0 - before / (before - above(depth)))) * ray;
        const bool bare = at.z() > options_.bare_from_m && at.z() < options_.bare_to_m;
        return options_.road && !bare ? std::optional(at) : std::nullopt;
      }
      if (std::abs(depth * ray.x()) > wall) return from + depth * ray;
    }
    return std::nullopt;
  }

  double Uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  double Normal() { return std::normal_distribution<double>(0.0, 1.0)(random_); }

  void Add() {
    const Eigen::Vector2d x(1.5 * Uniform() - 0.75, 1.1 * Uniform() - 0.55);
    const auto position = Meet(street_.T_cam_world.back().Inverse(), x);
    if (!position) return;
    Live track{next_id_++, *position, Eigen::Vector3d::Zero(), 0};
    if (Uniform() < options_.outliers)
      track.velocity = 0.02 * Eigen::Vector3d(3 * Normal(), 0.3 * Normal(), 6 * Normal());
    track.dies = static_cast<int>(street_.frames.size()) + 10 + static_cast<int>(50 * Uniform());
    if (track.velocity.isZero()) street_.born_at[track.id] = static_cast<int>(street_.frames.size()) - 1;
    live_.push_back(track);
  }

  void Move() {
    const int now = static_cast<int>(street_.frames.size());
    std::erase_if(live_, [&](Live& track) {
      track.position += track.velocity;
      const Eigen::Vector3d p = street_.T_cam_world.back() * track.position;
      return now >= track.dies || p.z() < 0.5 || std::abs(p.x()) > 0.8 * p.z() || std::abs(p.y()) > 0.6 * p.z();
    });
  }

  void Observe() {
    for (const Live& track : live_) {
      const Eigen::Vector3d p = street_.T_cam_world.back() * track.position;
      const Eigen::Vector2d noise = options_.noise_px / kFocalPx * Eigen::Vector2d(Normal(), Normal());
      street_.frames.back().features.push_back(
          {track.id, p.head<2>() / p.z() + noise, kFocalPx * Eigen::Matrix2d::Identity()});
    }
    for (const Live& track : live_) positions_[track.id] = track.position;
  }

  void Estimate() {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    for (int i = 0; i < options_.frames; ++i) {
      const double z = i * kStep;
      const bool lost = z >= options_.lost_at_m;
      const double scale = (lost ? 2.6 : 2.0) * (1.0 + 0.03 * std::sin(0.03 * z));
      street_.scale.push_back(scale);
      const geometry::SE3 T_world_cam = street_.T_cam_world[i].Inverse();
      if (i > 0) position += (T_world_cam.translation() - Pose(i - 1).translation()) / scale;
      if (street_.segments.size() < (lost ? 2u : 1u)) street_.segments.emplace_back();
      Segment& segment = street_.segments.back();
      segment.frames.push_back(i);
      segment.T_cam_world.push_back(geometry::SE3(T_world_cam.rotation(), position).Inverse());
      segment.inliers.push_back(100);
      for (const auto& [track, born_at] : street_.born_at) {
        if (born_at != i) continue;
        const Eigen::Vector3d seen = street_.T_cam_world[i] * positions_.at(track) / scale;
        segment.points.push_back({track, segment.T_cam_world.back().Inverse() * seen, 10, 0});
      }
    }
  }

  StreetOptions options_;
  std::mt19937 random_;
  Street street_;
  std::vector<Live> live_;
  std::map<std::int64_t, Eigen::Vector3d> positions_;
  std::int64_t next_id_ = 0;
};

GroundScale Scale(Street* street) {
  return ScaleByGround({.camera_height_m = kHeight}, street->frames, &street->segments);
}

std::vector<Eigen::Vector3d> Positions(const Street& street) {
  std::vector<Eigen::Vector3d> positions;
  for (const Segment& segment : street.segments) {
    for (const geometry::SE3& T_cam_world : segment.T_cam_world)
      positions.push_back(T_cam_world.Inverse().translation());
  }
  return positions;
}

/// Estimated over true length of the way between two frames, minus one.
double ScaleError(const Street& street, std::size_t from, std::size_t to) {
  const auto positions = Positions(street);
  double estimated = 0.0, truth = 0.0;
  for (std::size_t i = from + 1; i <= to; ++i) {
    estimated += (positions[i] - positions[i - 1]).norm();
    truth += (street.T_cam_world[i].Inverse().translation() - street.T_cam_world[i - 1].Inverse().translation()).norm();
  }
  return estimated / truth - 1.0;
}

/// The whole way within 0.5 %, and what is left of the drift.
void ExpectMetric(const Street& street, double local = 0.01) {
  const std::size_t last = street.frames.size() - 1;
  EXPECT_NEAR(ScaleError(street, 0, last), 0.0, 0.005);
  for (std::size_t i = 0; i + 200 <= last; i += 100) EXPECT_NEAR(ScaleError(street, i, i + 200), 0.0, local) << i;
}

TEST(GroundScale, TakesTheScaleAndItsDriftFromARoad) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Street street = StreetMaker({.seed = seed}).Make();
    EXPECT_GT(std::abs(ScaleError(street, 0, 999)), 0.4);
    const GroundScale scale = Scale(&street);
    EXPECT_TRUE(scale.found);
    EXPECT_GT(scale.tracks, 300u);
    EXPECT_GT(scale.covered, 0.99);
    EXPECT_LT(scale.error, 0.005);
    EXPECT_NEAR(scale.lowest, 1.94, 0.02);
    EXPECT_NEAR(scale.highest, 2.06, 0.02);
    ExpectMetric(street);
  }
}

TEST(GroundScale, MovesThePointsWithTheFramesThatSeeThem) {
  Street street = StreetMaker({}).Make();
  const Street before = street;
  Scale(&street);
  ASSERT_EQ(street.segments[0].points.size(), before.segments[0].points.size());
  for (std::size_t i = 0; i < street.segments[0].points.size(); ++i) {
    const Point& point = street.segments[0].points[i];
    const int frame = street.born_at.at(point.track);
    const Eigen::Vector3d seen = before.segments[0].T_cam_world[frame] * before.segments[0].points[i].position;
    const Eigen::Vector3d moved = street.segments[0].T_cam_world[frame] * point.position;
    EXPECT_LT((moved - street.scale[frame] * seen).norm(), 0.02 * moved.norm()) << i;
  }
}

TEST(GroundScale, KeepsRotationsAndTheFirstPose) {
  Street street = StreetMaker({.frames = 300, .bend = 0.002}).Make();
  street.segments[0].besides.assign(street.frames.size(), geometry::Matrix6d::Identity());
  const Street before = street;
  ASSERT_TRUE(Scale(&street).found);
  EXPECT_NEAR(street.segments[0].besides[100](1, 1), std::pow(street.scale[100], 2), 0.1);
  EXPECT_EQ(street.segments[0].besides[100](4, 4), 1.0);
  EXPECT_NEAR(street.segments[0].T_cam_world.front().translation().norm(), 0.0, 1e-9);
  for (std::size_t i = 0; i < street.frames.size(); ++i) {
    const auto& pose = street.segments[0].T_cam_world[i];
    EXPECT_LT(pose.rotation().angularDistance(before.segments[0].T_cam_world[i].rotation()), 1e-9);
  }
}

TEST(GroundScale, CameraMayLookDownOrUpOrBeRolled) {
  for (const double pitch : {-0.15, 0.2, 0.4}) {
    Street street = StreetMaker({.pitch = pitch, .roll = 0.05}).Make();
    EXPECT_TRUE(Scale(&street).found) << pitch;
    ExpectMetric(street);
  }
}

TEST(GroundScale, HillsAndBends) {
  Street street = StreetMaker({.bend = 0.004, .hills = 0.06}).Make();
  EXPECT_TRUE(Scale(&street).found);
  ExpectMetric(street, 0.015);
}

TEST(GroundScale, ACarMayRockOnItsSprings) {
  Street street = StreetMaker({.heave = 0.015}).Make();
  EXPECT_TRUE(Scale(&street).found);
  ExpectMetric(street, 0.015);
}

TEST(GroundScale, HoldsTheScaleWhereTheRoadIsBare) {
  Street street = StreetMaker({.bare_from_m = 60, .bare_to_m = 90}).Make();
  const GroundScale scale = Scale(&street);
  EXPECT_TRUE(scale.found);
  ExpectMetric(street, 0.02);
}

TEST(GroundScale, EachSegmentHasAScaleOfItsOwn) {
  Street street = StreetMaker({.lost_at_m = 90}).Make();
  ASSERT_EQ(street.segments.size(), 2u);
  const GroundScale scale = Scale(&street);
  EXPECT_TRUE(scale.found);
  EXPECT_GT(scale.highest, 2.5);
  EXPECT_NEAR(ScaleError(street, 0, 500), 0.0, 0.01);
  EXPECT_NEAR(ScaleError(street, 620, 999), 0.0, 0.01);
}

TEST(GroundScale, HoldsAHeightThatIsNotKnown) {
  for (const bool lost : {false, true}) {
    Street street = StreetMaker({.lost_at_m = lost ? 90 : 1e9}).Make();
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

void ExpectUntouched(const GroundOptions& options, Street street) {
  const Street before = street;
  EXPECT_FALSE(ScaleByGround(options, street.frames, &street.segments).found);
  for (std::size_t i = 0; i < street.frames.size(); ++i) {
    EXPECT_EQ(street.segments[0].T_cam_world[i].Matrix(), before.segments[0].T_cam_world[i].Matrix());
  }
  for (std::size_t i = 0; i < street.segments[0].points.size(); ++i) {
    EXPECT_EQ(street.segments[0].points[i].position, before.segments[0].points[i].position);
  }
}

TEST(GroundScale, WithoutGroundNothingChanges) {
  ExpectUntouched({}, StreetMaker({.road = false}).Make());
  ExpectUntouched({.camera_height_m = kHeight}, StreetMaker({.road = false}).Make());
}

TEST(GroundScale, ACameraThatDoesNotKeepItsHeightIsLeftAlone) {
  for (const double height_m : {0.0, kHeight}) {
    ExpectUntouched({.camera_height_m = height_m}, StreetMaker({.heave = 0.15}).Make());
    ExpectUntouched({.camera_height_m = height_m}, StreetMaker({.climb = 1.0}).Make());
  }
}

TEST(GroundScale, AShortWayTellsNothingOfAHeightThatIsNotKnown) {
  ExpectUntouched({}, StreetMaker({.frames = 80}).Make());
}

TEST(GroundScale, NothingToGoBy) {
  std::vector<Segment> none(1);
  EXPECT_FALSE(ScaleByGround({.camera_height_m = kHeight}, {}, &none).found);
  Street street = StreetMaker({.frames = 2}).Make();
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
  options.ground.camera_height_m = kHeight;
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
