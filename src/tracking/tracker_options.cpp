#include "evo/tracking/tracker_options.hpp"

namespace evo::tracking {

void Register(Parameters& parameters, TrackerOptions& o) {
  parameters.Add("tracker.method", &o.method, {"em", "klt"},
                 "expectation maximisation, or the baseline: KLT on images");
  parameters.Add("tracker.frame_interval_s", &o.frame_interval_s, 0.001, 1.0, "time between two event frames (s)");
  parameters.Add("tracker.features", &o.features, 8, 2000, "live features to aim at");
  parameters.Add("tracker.refill_below", &o.refill_below, 0.0, 1.0, "detect when fewer than this share is alive");
  parameters.Add("tracker.frames_between_refills", &o.frames_between_refills, 1, 1000,
                 "at least, from key frame to key frame; half as many where most features are missing");
  parameters.Add("tracker.flow_patch_radius_px", &o.flow_patch_radius_px, 5, 40,
                 "half the side of the patch that leads near a first flow (px)");
  parameters.Add("tracker.patch_radius_px", &o.patch_radius_px, 5, 40, "half the side of a feature's patch (px)");
  parameters.Add("tracker.window_motion_px", &o.window_motion_px, 0.5, 20.0, "motion within a feature's window (px)");
  parameters.Add("tracker.window_bend_px", &o.window_bend_px, 0.001, 1000.0,
                 "off a straight path within a window, by how the camera's turning usually changes (px)");
  parameters.Add("tracker.shortest_window_s", &o.shortest_window_s, 0.0005, 1.0, "of a feature's events (s)");
  parameters.Add("tracker.longest_window_s", &o.longest_window_s, 0.001, 1.0, "of a feature's events (s)");
  parameters.Add("tracker.fewest_events", &o.fewest_events, 10, 10000,
                 "in the window of a new feature, or of a patch that tells the flow");
  parameters.Add("tracker.fewest_events_alive", &o.fewest_events_alive, 5, 10000,
                 "lost with fewer in a doubled window");
  parameters.Add("tracker.resting_flow_px_s", &o.resting_flow_px_s, 0.0, 1000.0,
                 "a feature that moves no faster stays without events (px/s)");
  parameters.Add("tracker.most_events", &o.most_events, 50, 1000000, "in a patch's window: of more, an even sample");
  parameters.Add("tracker.flow_sigma_px", &o.flow_sigma_px, 0.3, 10.0, "soft association, first flow (px)");
  parameters.Add("tracker.coarse_sigma_px", &o.coarse_sigma_px, 0.3, 10.0,
                 "soft association where the fine alignment fails (px)");
  parameters.Add("tracker.fine_sigma_px", &o.fine_sigma_px, 0.3, 10.0,
                 "soft association, last flow and last alignment (px)");
  parameters.Add("tracker.outlier_share", &o.outlier_share, 0.0, 10.0, "density of stray events over the mean density");
  parameters.Add("tracker.iterations", &o.iterations, 1, 200, "of each expectation maximisation, at most");
  parameters.Add("tracker.flow_prior", &o.flow_prior, 0.0, 1e6, "weight of the predicted flow (events)");
  parameters.Add("tracker.affine_prior", &o.affine_prior, 0.0, 1e6, "weight of the predicted affine shape (events)");
  parameters.Add("tracker.template_gain", &o.template_gain, 0.0, 1.0,
                 "share of the newest window in a template, less where windows overlap");
  parameters.Add("tracker.ego_motion", &o.ego_motion, "predict patches by the camera's own motion");
  parameters.Add("tracker.follow_jolts", &o.follow_jolts,
                 "where all turn unexpectedly, align them again, expecting that");
  parameters.Add("tracker.restore_shake", &o.restore_shake,
                 "give back what windows smooth away when the camera shakes");
  parameters.Add("tracker.epipolar_filter", &o.epipolar_filter,
                 "take from the positions what they err by across their epipolar lines");
  parameters.Add("tracker.use_polarity", &o.use_polarity, "associate events of equal sign only");
  parameters.Add("tracker.fewest_inliers", &o.fewest_inliers, 0.0, 1.0, "share of events that the template explains");
  parameters.Add("tracker.largest_residual_px", &o.largest_residual_px, 0.1, 20.0,
                 "root mean square, after the fit (px)");
  parameters.Add("tracker.largest_jump_px", &o.largest_jump_px, 0.5, 50.0, "from the predicted position (px)");
  parameters.Add("tracker.largest_scale", &o.largest_scale, 1.1, 100.0, "of a patch against its first window");
  parameters.Add("tracker.border_px", &o.border_px, 1.0, 100.0, "give features up this near to the sensor's edge (px)");
  parameters.Add("tracker.corner_spacing_px", &o.corner_spacing_px, 1.0, 100.0, "between two features (px)");
  parameters.Add("tracker.corner_closest_px", &o.corner_closest_px, 1.0, 100.0,
                 "the same where that leaves room for too few (px)");
  parameters.Add("tracker.corner_share", &o.corner_share, 0.0, 1.0, "weakest corner as a share of a strong one");
  parameters.Add("tracker.corner_weakest_share", &o.corner_weakest_share, 0.0, 1.0,
                 "the same where that leaves too few");
  parameters.Add("tracker.corner_window_motion_px", &o.corner_window_motion_px, 0.5, 20.0, "in the corner image (px)");
  parameters.Add("tracker.uninformative_share", &o.uninformative_share, 0.0, 0.95,
                 "share of the new features that is refused: those whose events tell least of their position");
  parameters.Add("tracker.odd_share", &o.odd_share, 0.0, 0.5,
                 "share of the features that is withdrawn when young: those least like points at rest");
  parameters.Add("tracker.shortest_life_s", &o.shortest_life_s, 0.0, 10.0,
                 "a corner that leaves the image sooner is not taken (s)");
  parameters.Add("tracker.fewest_cells", &o.fewest_cells, 0.0, 1000.0, "that a template's events fill (px)");
  parameters.Add("tracker.klt.events", &o.klt.events, 100, 1000000, "newest events in an image, at most");
  parameters.Add("tracker.klt.longest_window_s", &o.klt.longest_window_s, 0.001, 1.0, "and none older than this (s)");
  parameters.Add("tracker.klt.patch_radius_px", &o.klt.patch_radius_px, 2, 40, "half the side of a patch (px)");
  parameters.Add("tracker.klt.forward_backward_px", &o.klt.forward_backward_px, 0.01, 20.0,
                 "lost if tracking back ends farther off (px)");
}

}  // namespace evo::tracking
