#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "evo/odometry/odometry_options.hpp"
#include "evo/odometry/point.hpp"
#include "odometry/frontend/frame.hpp"

namespace evo::odometry {

/// A first map. Its world is the camera of frame `first`.
struct Bootstrap {
  int first = 0;                           ///< index of the first frame
  int last = 0;                            ///< index of the last frame
  std::vector<geometry::SE3> T_cam_world;  ///< poses of the frames first ... last
  std::vector<Point> points;
};

/// Finds two frames whose relative motion the eight-point algorithm determines (D. Zhu, equations 9-13) and builds the
/// first map from them and the frames between. The candidates for the first frame are frames some image motion apart;
/// the oldest is paired with each new frame until it succeeds or is too far away.
class Bootstrapper {
 public:
  /// `frames` outlives this object; `focal_px` converts pixels to units of the normalized plane z = 1.
  Bootstrapper(const BootstrapOptions& options, const std::vector<Frame>& frames, double focal_px);

  /// Adds frame `index`. Returns the first map as soon as one can be built.
  std::optional<Bootstrap> Add(int index);
  /// Forgets all frames added so far.
  void Reset();

  /// Why there is no map yet, for the user.
  const std::string& failure_reason() const { return failure_reason_; }

 private:
  std::optional<Bootstrap> TryPair(int first, int last);
  /// Tries the last pair of a candidate whose tracks end before the image has moved far: behind another car, or slowly
  /// past near things. The parallax decides.
  std::optional<Bootstrap> TryLastPair(int first, int last);
  std::optional<Bootstrap> BuildMap(int first, int last, const std::vector<FeaturePair>& pairs,
                                    const geometry::SE3& T_2_1, const std::vector<bool>& inliers);
  /// Estimates the poses of the frames after the first against the points. False if one of them is not accepted.
  bool TrackFrames(Bootstrap* bootstrap) const;
  /// Adjusts points and some of the frames. False if the residuals stay large.
  bool RefineMap(Bootstrap* bootstrap) const;
  /// Whether the median of the points' parallaxes (rad) is large enough; records a failure otherwise.
  bool CheckParallax(const std::vector<double>& parallaxes);
  /// Records why there is no map; returns false.
  bool Fail(std::string reason);
  void DropOldestCandidate();

  BootstrapOptions options_;
  const std::vector<Frame>& frames_;
  double focal_px_;
  std::deque<int> candidates_;          // for the first frame, in order
  double next_try_disparity_px_ = 0.0;  // of the oldest candidate and the new frame
  std::string failure_reason_;
};

}  // namespace evo::odometry
