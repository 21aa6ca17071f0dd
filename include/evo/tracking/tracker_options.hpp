#pragma once

#include <string>

#include "evo/core/parameters.hpp"

namespace evo::tracking {

/// Parameters of the baseline, KLT on event images.
struct KltOptions {
  int events = 30000;                ///< newest events in an image
  double longest_window_s = 0.1;     ///< none older than this; with many events, images of a fixed time
  int patch_radius_px = 10;          ///< half the side of a feature's patch: 21 x 21 px
  double forward_backward_px = 1.0;  ///< lost if tracking back ends farther than this from where it came from
};

/// Parameters of the feature tracker (Zhu, Atanasov, Daniilidis: Event-based feature tracking with probabilistic data
/// association, ICRA 2017). One set serves all data sets.
struct TrackerOptions {
  std::string method = "em";       ///< em or klt
  double frame_interval_s = 0.02;  ///< time between two event frames
  int features = 150;              ///< live features to aim at
  double refill_below = 0.97;      ///< detect new ones when fewer than this share is alive: a key frame
  int frames_between_refills = 5;  ///< at least; half as many where most are missing
  int flow_patch_radius_px = 15;   ///< half the side of the patch that leads near a first flow: 31 x 31 px
  int patch_radius_px = 8;         ///< half the side of a feature's patch: 17 x 17 px; larger ones span more depths

  // The window of events around an event frame's stamp, chosen per feature.
  double window_motion_px = 5.0;  ///< the flow moves the feature this far within its window
  double window_bend_px = 0.15;   ///< nor does the camera, as its turning usually changes, bend its path by more
  double shortest_window_s = 0.004;
  double longest_window_s = 0.08;
  int fewest_events = 50;           ///< in a new feature's window
  int fewest_events_alive = 15;     ///< lost with fewer in a window twice as long,
  double resting_flow_px_s = 20.0;  ///< unless it moves no faster than this: then it stays without events
  int most_events = 250;            ///< in a patch's window: of more, an even sample is taken

  // Expectation maximisation.
  double flow_sigma_px = 1.5;    ///< soft association of events among themselves (EM 1), but for the last window
  double coarse_sigma_px = 2.5;  ///< soft association to the template (EM 2) where the fine one fails: a jolt
  double fine_sigma_px = 0.75;   ///< the same, final pass; also of the last window of EM 1
  double outlier_share = 0.2;    ///< density of stray events over the patch's mean density of events
  int iterations = 20;           ///< at most, each EM
  double flow_prior = 8.0;       ///< weight, in events, of the predicted flow
  double affine_prior = 20.0;    ///< weight, in events, of the predicted affine shape
  double template_gain = 0.1;    ///< share of a window in a template that has settled; less if it overlaps the last
  bool ego_motion = true;        ///< let the camera's own motion predict how patches move, grow and bend
  bool follow_jolts = true;      ///< where all turn unexpectedly, align them again, expecting that
  bool restore_shake = true;     ///< give back to the positions what windows smooth away while the camera shakes
  bool epipolar_filter = true;   ///< take from the positions what they err by across their epipolar lines
  bool use_polarity = true;      ///< associate events only with template events of their own sign

  // When a feature is lost.
  double fewest_inliers = 0.3;       ///< share of events that the template explains
  double largest_residual_px = 2.0;  ///< root mean square pull that is left on the events
  double largest_jump_px = 6.0;      ///< from where its flow predicted it
  double largest_scale = 3.0;        ///< of the patch against its first window, and its inverse: errors grow with it
  double border_px = 3.0;            ///< a feature closer than this to the edge of the sensor is given up

  // Corners.
  double corner_spacing_px = 10.0;     ///< smallest distance between two features when one is born
  double corner_closest_px = 6.0;      ///< the same where that one leaves room for too few
  double corner_share = 0.05;          ///< weakest corner accepted, as a share of a strong one (95th percentile)
  double corner_weakest_share = 0.02;  ///< the same where that leaves too few
  double corner_window_motion_px = 3.0;
  /// Share of the new features that is refused: those whose events tell least of their position, since their pattern
  /// may slide, is blurred or is not the same in both halves of the window.
  double uninformative_share = 0.55;
  /// Share of the features that is withdrawn, with all that was seen of them, once they are old enough to be judged:
  /// the least like points at rest, see OddityJudge.
  double odd_share = 0.03;
  double shortest_life_s = 0.12;  ///< a corner that leaves the image sooner than this is not taken
  double fewest_cells = 8.0;      ///< px that a template's events fill: a hot pixel fills one

  KltOptions klt;
};

void Register(Parameters& parameters, TrackerOptions& options);

}  // namespace evo::tracking
