#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "evo/odometry/odometry_options.hpp"
#include "evo/odometry/point.hpp"
#include "odometry/frontend/frame.hpp"

namespace evo::odometry {

/// A first map: the world is the camera of frame `first`.
struct Bootstrap {
  int first = 0;  ///< index of the frame
  int last = 0;
  std::vector<geometry::SE3> T_cam_world;  ///< of the frames first ... last
  std::vector<Point> points;
};

/// Finds two frames whose relative motion the eight-point algorithm can tell (equations 9-13) and makes the first map
/// of them and the frames between. Tries the oldest frame that it holds against the present one as the image moves on.
class Bootstrapper {
 public:
  /// `frames` outlives this object; `focal_px` turns pixels to units on the plane z = 1.
  Bootstrapper(const BootstrapOptions& options, const std::vector<Frame>& frames, double focal_px);

  /// Takes frame `index` into account; the first map as soon as there is one.
  std::optional<Bootstrap> Add(int index);
  /// Starts anew with the next frame.
  void Reset();

  /// Why there is no map yet, for the user.
  const std::string& obstacle() const { return obstacle_; }

 private:
  std::optional<Bootstrap> Try(int first, int last);
  std::optional<Bootstrap> FromMotion(int first, int last, const std::vector<FeaturePair>& pairs,
                                      const geometry::SE3& T_2_1, const std::vector<bool>& inliers);
  bool TrackBetween(Bootstrap* bootstrap) const;
  bool Refine(Bootstrap* bootstrap) const;
  /// Of the points' `parallaxes`, rad; refuses if not.
  bool HasParallax(const std::vector<double>& parallaxes);
  bool Refuse(const std::string& why);

  BootstrapOptions options_;
  const std::vector<Frame>& frames_;
  double focal_px_;
  std::deque<int> held_;
  double next_try_px_ = 0.0;
  std::string obstacle_;
};

}  // namespace evo::odometry
