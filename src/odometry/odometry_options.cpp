#include "evo/odometry/odometry_options.hpp"

#include "evo/core/parameters.hpp"

namespace evo::odometry {

namespace {

void Register(Parameters& parameters, ResamplingOptions& options) {
  parameters.Add("odometry.frame_interval_s", &options.frame_interval_s, 0.001, 1,
                 "interval between the frames made from asynchronous tracks (s)");
  parameters.Add("odometry.fit_window_s", &options.fit_window_s, 0, 0.5,
                 "half width of the line fit that places an asynchronous track in a frame (s)");
  parameters.Add("odometry.max_gap_s", &options.max_gap_s, 0.001, 10,
                 "longest gap of an asynchronous track that is interpolated (s)");
}

void Register(Parameters& parameters, KeyFrameOptions& options) {
  parameters.Add("odometry.key_frame.translation", &options.translation, 0.001, 10,
                 "translation since the last key frame that makes a new one, over the median depth of the scene");
  parameters.Add("odometry.key_frame.rotation_deg", &options.rotation_deg, 0.1, 180,
                 "rotation since the last key frame that makes a new one (deg)");
  parameters.Add("odometry.key_frame.disparity_px", &options.disparity_px, 1, 1000,
                 "median image motion since the last key frame that makes a new one (px)");
  parameters.Add("odometry.key_frame.min_shared_ratio", &options.min_shared_ratio, 0, 1,
                 "minimum ratio of a frame's tracks that the last key frame sees; below it a new one is made");
  parameters.Add("odometry.key_frame.min_disparity_px", &options.min_disparity_px, 0, 100,
                 "minimum median image motion between two key frames (px)");
  parameters.Add("odometry.key_frame.every_frames", &options.every_frames, 0, 1000,
                 "fixed interval of key frames that replaces these rules; 0: the rules (frames)");
}

void Register(Parameters& parameters, BootstrapOptions& options) {
  parameters.Add("odometry.bootstrap.min_disparity_px", &options.min_disparity_px, 1, 200,
                 "minimum median image motion between the two frames of a first map (px)");
  parameters.Add("odometry.bootstrap.max_disparity_px", &options.max_disparity_px, 2, 500,
                 "median image motion beyond which the older of the two frames is given up (px)");
  parameters.Add("odometry.bootstrap.inlier_px", &options.inlier_px, 0.1, 20,
                 "maximum Sampson error of an inlier of the essential matrix (px)");
  parameters.Add("odometry.bootstrap.min_inlier_ratio", &options.min_inlier_ratio, 0, 1,
                 "minimum ratio of inliers among the shared tracks");
  parameters.Add("odometry.bootstrap.min_inliers", &options.min_inliers, 8, 1000,
                 "minimum number of inliers of a first map");
  parameters.Add("odometry.bootstrap.min_shared_ratio", &options.min_shared_ratio, 0, 1,
                 "minimum ratio of the second frame's tracks that the first sees");
  parameters.Add("odometry.bootstrap.min_parallax_deg", &options.min_parallax_deg, 0.05, 30,
                 "minimum median parallax of the first map's points (deg)");
  parameters.Add("odometry.bootstrap.median_depth", &options.median_depth, 1e-3, 1e4,
                 "median depth of the first map, which sets the unit of length");
  parameters.Add("odometry.bootstrap.refine", &options.refine,
                 "bundle adjustment of the first map over the frames between the two");
}

void Register(Parameters& parameters, PoseOptions& options) {
  parameters.Add("odometry.pose.iterations", &options.iterations, 1, 100, "maximum Gauss-Newton iterations a frame");
  parameters.Add("odometry.pose.inlier_px", &options.inlier_px, 0.1, 20,
                 "residual below which a point is an inlier, and twice that above which it is an outlier (px)");
  parameters.Add("odometry.pose.min_inliers", &options.min_inliers, 4, 1000,
                 "minimum number of inliers of a pose; below it the tracking is lost");
  parameters.Add("odometry.pose.min_inlier_ratio", &options.min_inlier_ratio, 0, 1,
                 "minimum ratio of inliers of a pose; below it the tracking is lost");
}

void Register(Parameters& parameters, DepthFilterOptions& options) {
  parameters.Add("odometry.depth_filter.pixel_noise", &options.pixel_noise, 0.05, 10,
                 "standard deviation of an observation in the depth filter (px)");
  parameters.Add("odometry.depth_filter.convergence", &options.convergence, 5, 10000,
                 "ratio of a seed's inverse depth range to its standard deviation at which it converges");
  parameters.Add("odometry.depth_filter.epipolar_px", &options.epipolar_px, 0.1, 50,
                 "maximum distance of an observation from its epipolar line; beyond it the match failed (px)");
  parameters.Add("odometry.depth_filter.min_inlier_ratio", &options.min_inlier_ratio, 0, 1,
                 "minimum expected inlier ratio of a seed; below it the seed is dropped");
  parameters.Add("odometry.depth_filter.max_age", &options.max_age, 1, 1000,
                 "number of key frames after which a seed that has not converged is dropped");
}

void Register(Parameters& parameters, MapperOptions& options) {
  parameters.Add("odometry.window_refinement", &options.window_refinement,
                 "bundle adjustment of the last key frames at every key frame");
  parameters.Add("odometry.window", &options.window, 3, 100, "number of key frames in that window");
  parameters.Add("odometry.window_iterations", &options.window_iterations, 1, 100,
                 "maximum iterations of that adjustment");
  parameters.Add("odometry.loss_px", &options.loss_px, 0.05, 20, "width of that adjustment's Cauchy loss (px)");
  parameters.Add("odometry.depth_filter.update_px", &options.update_px, 0, 20,
                 "minimum median image motion between two updates of the depth filter (px)");
  parameters.Add("odometry.depth_filter.old_key_frames", &options.old_key_frames, 0, 100,
                 "number of earlier key frames that update a new seed");
  parameters.Add("odometry.max_outliers", &options.max_outliers, 1, 1000,
                 "number of frames that must contradict a point before it may be dropped");
  Register(parameters, options.depth_filter);
}

void Register(Parameters& parameters, FrameHandlerOptions& options) {
  parameters.Add("odometry.lag", &options.lag, 1, 100,
                 "delay after which the depths of a frame enter the map, for any number of threads (frames)");
  Register(parameters, options.key_frame);
  Register(parameters, options.bootstrap);
  Register(parameters, options.pose);
  Register(parameters, options.mapper);
}

void Register(Parameters& parameters, CovarianceOptions& options) {
  parameters.Add("odometry.covariance.variance_inflation", &options.variance_inflation, 1, 1000,
                 "factor on the poses' variances: the number of tracks that share their errors");
  parameters.Add("odometry.covariance.rotation_bias_ratio", &options.rotation_bias_ratio, 0, 1,
                 "standard deviation of the rotation common to all tracks about each axis, over their motion");
  parameters.Add("odometry.covariance.samples", &options.samples, 10, 10000,
                 "number of samples of the poses' joint errors that the covariances are computed from");
  parameters.Alias("odometry.covariance.alike", "odometry.covariance.variance_inflation");
  parameters.Alias("odometry.covariance.turn", "odometry.covariance.rotation_bias_ratio");
}

void Register(Parameters& parameters, FinalRefinementOptions& options) {
  parameters.Add("odometry.final_refinement", &options.enabled, "bundle adjustment of the whole run at its end");
  parameters.Add("odometry.final.min_disparity_px", &options.min_disparity_px, 0, 100,
                 "minimum median image motion between the frames that take part (px)");
  parameters.Add("odometry.final.drift_variance_ratio", &options.drift_variance_ratio, 0, 100,
                 "variance of a track's drift from frame to frame, over that of its noise");
  parameters.Add("odometry.final.velocity_change_scale", &options.velocity_change_scale, 0, 1000,
                 "expected change of velocity, over the typical one; 0: no motion prior");
  parameters.Add("odometry.final.track_noise", &options.track_noise, "weight of each track by its own noise");
  parameters.Add("odometry.final.iterations", &options.iterations, 1, 1000, "maximum iterations of each round");
  parameters.Add("odometry.final.rounds", &options.rounds, 1, 100,
                 "number of adjustments, each with the noise estimated again");
  parameters.Add(
      "odometry.final.max_block_products", &options.max_block_products, 1e3, 1e12,
      "maximum number of 6x6 block products of an iteration, beyond which tracks are cut and frames left out");
  parameters.Alias("odometry.final.drift", "odometry.final.drift_variance_ratio");
  parameters.Alias("odometry.final.motion", "odometry.final.velocity_change_scale");
  parameters.Alias("odometry.final.own_noise", "odometry.final.track_noise");
  parameters.Alias("odometry.final.budget", "odometry.final.max_block_products");
  Register(parameters, options.covariance);
}

void Register(Parameters& parameters, GroundOptions& options) {
  parameters.Add("odometry.ground.hold_height", &options.hold_height,
                 "constant height of the camera above the road, which removes the drift of the scale");
  parameters.Add("odometry.ground.camera_height_m", &options.camera_height_m, 0, 100,
                 "height of the camera above the road, which makes the scale metric; 0: unknown (m)");
  parameters.Add("odometry.ground.scale_drift_ratio", &options.scale_drift_ratio, 0, 1,
                 "standard deviation of the scale's relative change over a path of one camera height; 0: from the "
                 "covariance of the poses");
  parameters.Add("odometry.ground.roll_drift", &options.roll_drift, 1e-7, 1,
                 "standard deviation of the change of the road's roll against the camera over a path of one camera "
                 "height (rad)");
  parameters.Add("odometry.ground.common_sigma_ratio", &options.common_sigma_ratio, 0, 1,
                 "relative standard deviation of the scale that all tracks on the ground have in common");
  parameters.Add("odometry.ground.max_lateral_ratio", &options.max_lateral_ratio, 0.01, 10,
                 "maximum lateral offset of a track on the ground, over its depth below the path");
  parameters.Add("odometry.ground.min_path_heights", &options.min_path_heights, 0, 1e6,
                 "minimum path length at which an unknown height counts as constant (camera heights)");
  parameters.Alias("odometry.ground.drift", "odometry.ground.scale_drift_ratio");
}

}  // namespace

void Register(Parameters& parameters, OdometryOptions& options) {
  Register(parameters, options.resampling);
  Register(parameters, options.frame_handler);
  parameters.Add("odometry.backward_tracking", &options.backward_tracking,
                 "track the frames before the first map backwards from it");
  Register(parameters, options.final_refinement);
  Register(parameters, options.ground);
}

}  // namespace evo::odometry
