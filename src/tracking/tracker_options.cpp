#include "evo/tracking/tracker_options.hpp"

namespace evo::tracking {

namespace {

void RegisterFeatures(Parameters& parameters, TrackerOptions& o) {
  parameters.Add("tracker.method", &o.method, {"em", "klt"},
                 "expectation maximisation on events, or the baseline: KLT on event images");
  parameters.Add("tracker.frame_interval_s", &o.frame_interval_s, 0.001, 1.0, "time between two event frames (s)");
  parameters.Add("tracker.features", &o.features, 8, 2000, "number of live features to aim at");
  parameters.Add("tracker.refill_below", &o.refill_below, 0.0, 1.0,
                 "ratio of live features to `features` below which new ones are detected");
  parameters.Add("tracker.frames_between_refills", &o.frames_between_refills, 1, 1000,
                 "minimum number of frames between two detections; half of it when most features are missing");
  parameters.Add("tracker.flow_patch_radius_px", &o.flow_patch_radius_px, 5, 40,
                 "half side of the patch of the first, coarse flow (px)");
  parameters.Add("tracker.patch_radius_px", &o.patch_radius_px, 5, 40, "half side of a feature's patch (px)");
}

void RegisterWindow(Parameters& parameters, TrackerOptions& o) {
  parameters.Add("tracker.window_motion_px", &o.window_motion_px, 0.5, 20.0,
                 "motion of a feature within its window of events (px)");
  parameters.Add(
      "tracker.window_curvature_px", &o.window_curvature_px, 0.001, 1000.0,
      "maximum deviation from a straight path within half a window, by the typical angular acceleration (px)");
  parameters.Add("tracker.min_window_s", &o.min_window_s, 0.0005, 1.0, "minimum length of a window (s)");
  parameters.Add("tracker.max_window_s", &o.max_window_s, 0.001, 1.0, "maximum length of a window (s)");
  parameters.Add("tracker.min_events", &o.min_events, 10, 10000,
                 "minimum number of events in the window of a new feature or of a flow");
  parameters.Add("tracker.min_events_established", &o.min_events_established, 5, 10000,
                 "minimum number of events in the doubled window of an established feature");
  parameters.Add("tracker.resting_flow_px_s", &o.resting_flow_px_s, 0.0, 1000.0,
                 "maximum flow of a feature that is kept without events (px/s)");
  parameters.Add("tracker.max_events", &o.max_events, 50, 1000000,
                 "maximum number of events of a window; more are sampled evenly");
}

void RegisterExpectationMaximisation(Parameters& parameters, TrackerOptions& o) {
  parameters.Add("tracker.flow_sigma_px", &o.flow_sigma_px, 0.3, 10.0,
                 "standard deviation of the soft association of the first flow (px)");
  parameters.Add("tracker.coarse_sigma_px", &o.coarse_sigma_px, 0.3, 10.0,
                 "standard deviation of the soft association where the fine alignment fails (px)");
  parameters.Add("tracker.fine_sigma_px", &o.fine_sigma_px, 0.3, 10.0,
                 "standard deviation of the soft association of the last flow and of the alignment (px)");
  parameters.Add("tracker.outlier_density_ratio", &o.outlier_density_ratio, 0.0, 10.0,
                 "ratio of the outliers' density to the mean density of a patch");
  parameters.Add("tracker.iterations", &o.iterations, 1, 200,
                 "maximum number of iterations of each expectation maximisation");
  parameters.Add("tracker.flow_prior", &o.flow_prior, 0.0, 1e6, "weight of the predicted flow (events)");
  parameters.Add("tracker.affine_prior", &o.affine_prior, 0.0, 1e6, "weight of the predicted affine shape (events)");
  parameters.Add("tracker.template_gain", &o.template_gain, 0.0, 1.0,
                 "weight of a new window in an established template; less if it overlaps the last one");
}

void RegisterCameraMotion(Parameters& parameters, TrackerOptions& o) {
  parameters.Add("tracker.ego_motion", &o.ego_motion, "predict patches by the camera's own motion");
  parameters.Add("tracker.rotation_correction", &o.rotation_correction,
                 "align all features again after an unpredicted rotation of the camera");
  parameters.Add("tracker.rotation_spline", &o.rotation_spline,
                 "restore the fast rotation that windows average away, by a spline");
  parameters.Add("tracker.epipolar_filter", &o.epipolar_filter, "filter the positions across their epipolar lines");
  parameters.Add("tracker.use_polarity", &o.use_polarity, "associate only events of equal polarity");
  parameters.Add("tracker.predict_polarity", &o.predict_polarity,
                 "flip the polarities of edges that the motion crosses the other way");
}

void RegisterLoss(Parameters& parameters, TrackerOptions& o) {
  parameters.Add("tracker.min_inlier_ratio", &o.min_inlier_ratio, 0.0, 1.0,
                 "minimum ratio of a window's events that the template explains");
  parameters.Add("tracker.min_log_likelihood_ratio", &o.min_log_likelihood_ratio, -10.0, 10.0,
                 "minimum log likelihood ratio of the template against noise, of a window and over the last windows "
                 "(nats an event)");
  parameters.Add("tracker.max_residual_px", &o.max_residual_px, 0.1, 20.0,
                 "maximum root mean square residual of an alignment (px)");
  parameters.Add("tracker.max_prediction_error_px", &o.max_prediction_error_px, 0.5, 50.0,
                 "maximum distance from the predicted to the aligned position (px)");
  parameters.Add("tracker.innovation_gate", &o.innovation_gate, 1.0, 1000.0,
                 "maximum distance from the predicted to the aligned position over the median of all features");
  parameters.Add("tracker.min_innovation_gate_px", &o.min_innovation_gate_px, 0.0, 50.0,
                 "added to that maximum distance (px)");
  parameters.Add("tracker.max_scale", &o.max_scale, 1.1, 100.0,
                 "maximum scale, or its inverse, of a patch relative to its first window");
  parameters.Add("tracker.border_px", &o.border_px, 1.0, 100.0,
                 "minimum distance of a feature from the sensor's edge (px)");
}

void RegisterDetection(Parameters& parameters, TrackerOptions& o) {
  parameters.Add("tracker.corner_spacing_px", &o.corner_spacing_px, 1.0, 100.0,
                 "minimum distance of a new feature from all others (px)");
  parameters.Add("tracker.corner_min_spacing_px", &o.corner_min_spacing_px, 1.0, 100.0,
                 "the same where `corner_spacing_px` leaves too few corners (px)");
  parameters.Add("tracker.corner_quality_ratio", &o.corner_quality_ratio, 0.0, 1.0,
                 "minimum response of a corner, relative to the 95th percentile");
  parameters.Add("tracker.corner_min_quality_ratio", &o.corner_min_quality_ratio, 0.0, 1.0,
                 "the same where `corner_quality_ratio` leaves too few corners");
  parameters.Add("tracker.corner_window_motion_px", &o.corner_window_motion_px, 0.5, 20.0,
                 "motion within the windows of the motion-compensated event image (px)");
  parameters.Add("tracker.uninformative_ratio", &o.uninformative_ratio, 0.0, 0.95,
                 "ratio of new features refused: those whose events constrain their position least");
  parameters.Add("tracker.rejection_ratio", &o.rejection_ratio, 0.0, 0.5,
                 "ratio of young features rejected with all their observations: those with the highest outlier score");
  parameters.Add("tracker.min_expected_lifetime_s", &o.min_expected_lifetime_s, 0.0, 10.0,
                 "minimum time until a new feature leaves the image (s)");
  parameters.Add("tracker.min_template_area_px", &o.min_template_area_px, 0.0, 1000.0,
                 "minimum number of pixels that the events of a new template cover (px)");
}

void RegisterKlt(Parameters& parameters, KltOptions& o) {
  parameters.Add("tracker.klt.events", &o.events, 100, 1000000, "number of newest events in an image");
  parameters.Add("tracker.klt.max_window_s", &o.max_window_s, 0.001, 1.0, "maximum age of an event in an image (s)");
  parameters.Add("tracker.klt.patch_radius_px", &o.patch_radius_px, 2, 40, "half side of a patch (px)");
  parameters.Add("tracker.klt.forward_backward_px", &o.forward_backward_px, 0.01, 20.0,
                 "maximum distance between a position and its forward-backward track (px)");
}

/// Names of versions before 1.0.
void RegisterAliases(Parameters& parameters) {
  parameters.Alias("tracker.window_bend_px", "tracker.window_curvature_px");
  parameters.Alias("tracker.shortest_window_s", "tracker.min_window_s");
  parameters.Alias("tracker.longest_window_s", "tracker.max_window_s");
  parameters.Alias("tracker.fewest_events", "tracker.min_events");
  parameters.Alias("tracker.fewest_events_alive", "tracker.min_events_established");
  parameters.Alias("tracker.most_events", "tracker.max_events");
  parameters.Alias("tracker.outlier_share", "tracker.outlier_density_ratio");
  parameters.Alias("tracker.follow_jolts", "tracker.rotation_correction");
  parameters.Alias("tracker.restore_shake", "tracker.rotation_spline");
  parameters.Alias("tracker.fewest_inliers", "tracker.min_inlier_ratio");
  parameters.Alias("tracker.largest_residual_px", "tracker.max_residual_px");
  parameters.Alias("tracker.largest_jump_px", "tracker.max_prediction_error_px");
  parameters.Alias("tracker.largest_scale", "tracker.max_scale");
  parameters.Alias("tracker.corner_closest_px", "tracker.corner_min_spacing_px");
  parameters.Alias("tracker.corner_share", "tracker.corner_quality_ratio");
  parameters.Alias("tracker.corner_weakest_share", "tracker.corner_min_quality_ratio");
  parameters.Alias("tracker.uninformative_share", "tracker.uninformative_ratio");
  parameters.Alias("tracker.odd_share", "tracker.rejection_ratio");
  parameters.Alias("tracker.shortest_life_s", "tracker.min_expected_lifetime_s");
  parameters.Alias("tracker.fewest_cells", "tracker.min_template_area_px");
  parameters.Alias("tracker.klt.longest_window_s", "tracker.klt.max_window_s");
}

}  // namespace

void Register(Parameters& parameters, TrackerOptions& options) {
  RegisterFeatures(parameters, options);
  RegisterWindow(parameters, options);
  RegisterExpectationMaximisation(parameters, options);
  RegisterCameraMotion(parameters, options);
  RegisterLoss(parameters, options);
  RegisterDetection(parameters, options);
  RegisterKlt(parameters, options.klt);
  RegisterAliases(parameters);
}

}  // namespace evo::tracking
