#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/evaluation/evaluation_options.hpp"
#include "evo/events/depth_map.hpp"
#include "evo/events/tracks.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/geometry/trajectory.hpp"

namespace evo::evaluation {

/// A depth map with the pose of its camera.
struct DepthView {
  TimeNs t = 0;
  geometry::SE3 T_cam_world;
  events::DepthMap map;
};

/// Intersects rays with depth maps and projects points into the moving camera. Trajectory and camera must outlive it.
class DepthReprojection {
 public:
  DepthReprojection(const geometry::Trajectory& trajectory, const geometry::Camera& camera, TimeNs max_gap,
                    const TrackTruthOptions& options);

  /// T_cam_world at `t`; empty outside the trajectory and in its gaps.
  std::optional<geometry::SE3> CameraAt(TimeNs t) const;

  /// Point (world frame) in which the ray of `observation` from the camera at `T_cam_world` meets the surface of the
  /// map; empty if the depth there is unknown or discontinuous.
  std::optional<Eigen::Vector3d> IntersectSurface(const events::TrackObservation& observation,
                                                  const geometry::SE3& T_cam_world, const DepthView& view) const;

  /// Points on the ray from the camera at `T_cam_world` through `position_world`, at the depths of the other surfaces
  /// within the surface radius.
  std::vector<Eigen::Vector3d> IntersectOtherSurfaces(const Eigen::Vector3d& position_world,
                                                      const geometry::SE3& T_cam_world, const DepthView& view) const;

  /// Whether the map marks a moving object within the surface radius of a point's image.
  bool IsNearMovingObject(const Eigen::Vector3d& position_world, const DepthView& view) const;

  /// Whether a point lies behind all surfaces that the map has at its image.
  bool IsOccluded(const Eigen::Vector3d& position_world, const DepthView& view) const;

  /// Image of a point at `t` (px); empty if it is not in the image.
  std::optional<Eigen::Vector2d> ProjectAt(const Eigen::Vector3d& position_world, TimeNs t) const;

  /// Last time before a point leaves the image, given that it is in the image at `inside` and not at `outside`.
  TimeNs LastTimeInImage(const Eigen::Vector3d& position_world, TimeNs inside, TimeNs outside) const;

 private:
  /// Image of a point in camera coordinates (px); empty if it is not in the image.
  std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& position_cam) const;
  template <typename Visitor>
  void VisitNeighbourhood(const Eigen::Vector3d& position_world, const DepthView& view, const Visitor& visit) const;
  std::vector<double> OtherSurfaceDepths(const Eigen::Vector3d& position_world, const DepthView& view) const;
  std::optional<double> SurfaceDepth(const events::DepthMap& map, const Eigen::Vector2d& pixel) const;

  const geometry::Trajectory& trajectory_;
  const geometry::Camera& camera_;
  TimeNs max_gap_;
  double depth_edge_ratio_;
  double surface_radius_px_;
};

}  // namespace evo::evaluation
