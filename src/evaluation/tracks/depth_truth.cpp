#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "evaluation/tracks/sensor_fit.hpp"
#include "evo/core/error.hpp"
#include "evo/evaluation/track_truth.hpp"

namespace evo::evaluation {

namespace {

constexpr TimeNs kFarthestMap = kNsPerSecond / 10;  // a map farther away in time may show another surface
constexpr int kDepthIterations = 50;
constexpr double kDepthTolerance = 1e-9;  // relative
constexpr int kBisections = 30;
constexpr double kSameRay = 1e-6;  // on the plane z = 1

/// The four pixels around a position and their weights.
struct Neighbours {
  std::array<double, 4> depth;
  std::array<double, 4> weight;
};

/// `pixel` must lie on the map, which has two rows and columns or more.
Neighbours FindNeighbours(const events::DepthMap& map, const Eigen::Vector2d& pixel) {
  const int x = std::min(static_cast<int>(pixel.x()), map.width - 2);
  const int y = std::min(static_cast<int>(pixel.y()), map.height - 2);
  const double right = pixel.x() - x;
  const double down = pixel.y() - y;
  return {{map.At(x, y), map.At(x + 1, y), map.At(x, y + 1), map.At(x + 1, y + 1)},
          {(1.0 - right) * (1.0 - down), right * (1.0 - down), (1.0 - right) * down, right * down}};
}

bool IsKnown(double depth) { return std::isfinite(depth) && depth > 0.0; }

/// One point of a track as it goes through the maps.
struct Point {
  std::size_t track = 0;
  std::optional<std::size_t> beside;  ///< index in TrueTrack::beside; empty: the track's own point
  Eigen::Vector3d position_world;
  TimeNs seen = 0;  ///< the last instant at which it was found visible
};

/// One depth map with its camera.
struct DepthView {
  TimeNs t = 0;
  geometry::SE3 T_cam_world;
  events::DepthMap map;
};

class DepthOracle {
 public:
  DepthOracle(const geometry::Trajectory& trajectory, const geometry::Camera& camera, TimeNs max_gap,
              const TrackTruthOptions& options)
      : trajectory_(trajectory),
        camera_(camera),
        max_gap_(max_gap),
        edge_(options.depth_edge),
        reach_px_(options.surface_reach_px) {}

  std::optional<geometry::SE3> CamFromWorld(TimeNs t) const {
    const auto T_world_cam = geometry::PoseAt(trajectory_, t, max_gap_);
    return T_world_cam ? std::optional(T_world_cam->Inverse()) : std::nullopt;
  }

  /// Where the ray of `observation` meets the surface of the map: the point of the ray that the camera of the map would
  /// see at the depth that the map has there, by fixed-point iteration.
  std::optional<Eigen::Vector3d> Locate(const events::TrackObservation& observation, const geometry::SE3& T_cam_world,
                                        const DepthView& view) const {
    const Eigen::Vector2d pixel(observation.x, observation.y);
    const auto x = camera_.Contains(pixel) ? camera_.Undistort(pixel) : std::nullopt;
    if (!x) return std::nullopt;
    const geometry::SE3 T_world_cam = T_cam_world.Inverse();
    const geometry::SE3 T_map_cam = view.T_cam_world * T_world_cam;
    const Eigen::Vector3d ray = T_map_cam.rotation() * x->homogeneous();
    auto depth = SurfaceDepth(view.map, pixel);
    double z = depth.value_or(0.0);
    for (int i = 0; depth && i < kDepthIterations; ++i) {
      const Eigen::Vector3d p = z * ray + T_map_cam.translation();
      const auto seen = Seen(p);
      depth = seen ? SurfaceDepth(view.map, *seen) : std::nullopt;
      if (!depth || !(ray.z() > 0.0)) return std::nullopt;
      const double change = (*depth - p.z()) / ray.z();
      z += change;
      if (std::abs(change) <= kDepthTolerance * z) return T_world_cam * (z * x->homogeneous());
    }
    return std::nullopt;
  }

  /// Whether something moves around the place of a point.
  bool MovesBeside(const Eigen::Vector3d& position_world, const DepthView& view) const {
    bool moves = false;
    ForEachBeside(position_world, view, [&](int x, int y, double) { moves = moves || view.map.IsMoving(x, y); });
    return moves;
  }

  /// The points on the ray from a camera through a point, at the depths of the other surfaces around its place.
  std::vector<Eigen::Vector3d> LocateBeside(const Eigen::Vector3d& position_world, const geometry::SE3& T_cam_world,
                                            const DepthView& view) const {
    const Eigen::Vector3d centre = T_cam_world.Inverse().translation();
    const double from = (view.T_cam_world * centre).z();
    const double to = (view.T_cam_world * position_world).z();
    std::vector<Eigen::Vector3d> points;
    for (const double depth : OtherDepths(position_world, view)) {
      const double along = (depth - from) / (to - from);
      if (along > 0.0) points.push_back(centre + along * (position_world - centre));
    }
    return points;
  }

  /// Where the camera sees a point, given in its coordinates; empty if it does not.
  std::optional<Eigen::Vector2d> Seen(const Eigen::Vector3d& p) const {
    if (!(p.z() > 0.0)) return std::nullopt;
    const Eigen::Vector2d pixel = camera_.Project(p);
    if (!camera_.Contains(pixel)) return std::nullopt;
    // Far outside its field of view a lens model may fold back onto the sensor.
    const auto x = camera_.Undistort(pixel);
    if (!x || (*x - p.head<2>() / p.z()).norm() > kSameRay * (1.0 + x->norm())) return std::nullopt;
    return pixel;
  }

  std::optional<Eigen::Vector2d> SeenAt(const Eigen::Vector3d& position_world, TimeNs t) const {
    const auto T_cam_world = CamFromWorld(t);
    return T_cam_world ? Seen(*T_cam_world * position_world) : std::nullopt;
  }

  /// Well behind everything that the map has around its place.
  bool IsOccluded(const Eigen::Vector3d& position_world, const DepthView& view) const {
    const Eigen::Vector3d p = view.T_cam_world * position_world;
    const auto pixel = Seen(p);
    if (!pixel) return false;
    double farthest = 0.0;
    for (const double depth : FindNeighbours(view.map, *pixel).depth) {
      if (IsKnown(depth)) farthest = std::max(farthest, depth);
    }
    return farthest > 0.0 && p.z() > (1.0 + edge_) * farthest;
  }

  /// The last instant before the point leaves the image, which it does between `inside` and `outside`.
  TimeNs LeavesAt(const Eigen::Vector3d& position_world, TimeNs inside, TimeNs outside) const {
    for (int i = 0; i < kBisections && outside - inside > 1; ++i) {
      const TimeNs middle = inside + (outside - inside) / 2;
      (SeenAt(position_world, middle) ? inside : outside) = middle;
    }
    return inside;
  }

 private:
  /// Calls visit(x, y, squared distance) for the pixels around the place of a point.
  template <typename Visitor>
  void ForEachBeside(const Eigen::Vector3d& position_world, const DepthView& view, const Visitor& visit) const {
    const auto seen = Seen(view.T_cam_world * position_world);
    if (!seen) return;
    const double reach = std::max(reach_px_, 1.0);
    const auto from = [&](double centre) { return std::max(0, static_cast<int>(std::ceil(centre - reach))); };
    const auto to = [&](double centre, int size) {
      return std::min(size - 1, static_cast<int>(std::floor(centre + reach)));
    };
    for (int y = from(seen->y()); y <= to(seen->y(), view.map.height); ++y) {
      for (int x = from(seen->x()); x <= to(seen->x(), view.map.width); ++x) {
        const double distance2 = (Eigen::Vector2d(x, y) - *seen).squaredNorm();
        if (distance2 <= reach * reach) visit(x, y, distance2);
      }
    }
  }

  /// One for each surface beside the point's own: where it is nearest to the point's place.
  std::vector<double> OtherDepths(const Eigen::Vector3d& position_world, const DepthView& view) const {
    if (!(reach_px_ > 0.0)) return {};
    struct Pixel {
      double depth, distance2;
    };
    std::vector<Pixel> pixels;
    ForEachBeside(position_world, view, [&](int x, int y, double distance2) {
      if (IsKnown(view.map.At(x, y))) pixels.push_back({view.map.At(x, y), distance2});
    });
    std::ranges::sort(pixels, {}, &Pixel::depth);
    const double own = (view.T_cam_world * position_world).z();
    std::vector<double> depths;
    for (auto begin = pixels.begin(), end = begin; begin != pixels.end(); begin = end) {
      for (++end; end != pixels.end() && end->depth <= (1.0 + edge_) * (end - 1)->depth;) ++end;
      if (own >= begin->depth / (1.0 + edge_) && own <= (1.0 + edge_) * (end - 1)->depth) continue;
      depths.push_back(std::ranges::min_element(begin, end, {}, &Pixel::distance2)->depth);
    }
    return depths;
  }

  /// Interpolated in inverse depth, which is linear on a plane. Empty where unknown or across an edge.
  std::optional<double> SurfaceDepth(const events::DepthMap& map, const Eigen::Vector2d& pixel) const {
    const Neighbours near = FindNeighbours(map, pixel);
    if (!std::ranges::all_of(near.depth, IsKnown)) return std::nullopt;
    if (std::ranges::max(near.depth) > (1.0 + edge_) * std::ranges::min(near.depth)) return std::nullopt;
    double inverse = 0.0;
    for (std::size_t i = 0; i < near.depth.size(); ++i) inverse += near.weight[i] / near.depth[i];
    return 1.0 / inverse;
  }

  const geometry::Trajectory& trajectory_;
  const geometry::Camera& camera_;
  TimeNs max_gap_;
  double edge_;
  double reach_px_;
};

/// Indices of the tracks that begin nearest to each map.
std::vector<std::vector<std::size_t>> FindStarts(const std::vector<FeatureTrack>& tracks,
                                                 const std::vector<TimeNs>& stamps) {
  std::vector<std::vector<std::size_t>> starts(stamps.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const TimeNs t = tracks[i].observations.front().t;
    auto nearest = std::ranges::lower_bound(stamps, t);
    if (nearest == stamps.end() || (nearest != stamps.begin() && t - *(nearest - 1) <= *nearest - t)) --nearest;
    if (std::abs(*nearest - t) <= kFarthestMap) starts[static_cast<std::size_t>(nearest - stamps.begin())].push_back(i);
  }
  return starts;
}

/// Goes through the maps in order of time with all points that are visible, so that each map is read once at most.
class PointFollower {
 public:
  PointFollower(const std::vector<FeatureTrack>& tracks, const DepthOracle& oracle, std::vector<TrueTrack>* results)
      : tracks_(tracks), oracle_(oracle), results_(*results) {}

  bool idle() const { return points_.empty(); }

  void Start(const std::vector<std::size_t>& starting, const DepthView& view) {
    for (const std::size_t track : starting) {
      const auto& first = tracks_[track].observations.front();
      const auto T_cam_world = oracle_.CamFromWorld(first.t);
      if (!T_cam_world) continue;
      const auto position = oracle_.Locate(first, *T_cam_world, view);
      if (!position) continue;
      TrueTrack& result = results_[track];
      if (oracle_.MovesBeside(*position, view)) {
        result.verdict = TrackVerdict::kMoves;
        continue;
      }
      result.verdict = TrackVerdict::kJudged;
      points_.push_back({track, std::nullopt, *position, first.t});
      for (const auto& other : oracle_.LocateBeside(*position, *T_cam_world, view)) {
        points_.push_back({track, result.beside.size(), other, first.t});
        result.beside.emplace_back(tracks_[track].observations.size());
      }
    }
  }

  void CheckOcclusion(const DepthView& view) {
    std::erase_if(points_, [&](const Point& point) {
      const bool occluded = !point.beside && point.seen < view.t && oracle_.IsOccluded(point.position_world, view);
      if (occluded) End(point, point.seen);
      return occluded;
    });
  }

  void CheckInImage(TimeNs t) {
    std::erase_if(points_, [&](Point& point) {
      if (point.seen >= t) return false;
      const bool seen = oracle_.SeenAt(point.position_world, t).has_value();
      if (!seen) End(point, oracle_.LeavesAt(point.position_world, point.seen, t));
      point.seen = t;
      return !seen;
    });
  }

  void EndAll() {
    for (const Point& point : points_) End(point, point.seen);
    points_.clear();
  }

 private:
  void End(const Point& point, TimeNs until) {
    TrueTrack& result = results_[point.track];
    if (!point.beside) result.visible_until = until;
    auto& positions = point.beside ? result.beside[*point.beside] : result.positions;
    const auto& observations = tracks_[point.track].observations;
    for (std::size_t i = 0; i < observations.size() && observations[i].t <= until; ++i) {
      positions[i] = oracle_.SeenAt(point.position_world, observations[i].t);
    }
  }

  const std::vector<FeatureTrack>& tracks_;
  const DepthOracle& oracle_;
  std::vector<TrueTrack>& results_;
  std::vector<Point> points_;
};

void CheckSize(const io::DepthMapReader& maps, const geometry::Camera& camera) {
  if (maps.width() == camera.width() && maps.height() == camera.height() && maps.width() > 1 && maps.height() > 1) {
    return;
  }
  throw Error(ErrorKind::kInput, "the depth maps of " + std::to_string(maps.width()) + " x " +
                                     std::to_string(maps.height()) + " px do not belong to the calibrated " +
                                     std::to_string(camera.width()) + " x " + std::to_string(camera.height()) +
                                     " sensor");
}

}  // namespace

std::vector<TrueTrack> TruthFromDepth(const std::vector<FeatureTrack>& tracks, const geometry::Trajectory& trajectory,
                                      const geometry::Camera& camera, const io::DepthMapReader& maps, TimeNs max_gap,
                                      const TrackTruthOptions& options) {
  CheckSize(maps, camera);
  CheckSensorFit(tracks, camera);
  const DepthOracle oracle(trajectory, camera, max_gap, options);
  std::vector<TrueTrack> results(tracks.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const auto& observations = tracks[i].observations;
    const bool has_pose = oracle.CamFromWorld(observations.front().t).has_value();
    results[i].verdict = has_pose ? TrackVerdict::kNoDepth : TrackVerdict::kNoTruth;  // until it starts
    results[i].positions.resize(observations.size());
    results[i].starts_at_observation = true;
  }
  PointFollower follower(tracks, oracle, &results);
  const auto starts = FindStarts(tracks, maps.stamps());
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const TimeNs t = maps.stamps()[i];
    const auto T_cam_world = oracle.CamFromWorld(t);
    if (!T_cam_world || (starts[i].empty() && follower.idle())) continue;
    const DepthView view{t, *T_cam_world, maps.Read(i)};
    follower.CheckOcclusion(view);
    follower.Start(starts[i], view);
    follower.CheckInImage(t);
  }
  if (!trajectory.empty()) {
    follower.CheckInImage(std::min(trajectory.back().t, maps.stamps().back() + kFarthestMap));
  }
  follower.EndAll();
  return results;
}

}  // namespace evo::evaluation
