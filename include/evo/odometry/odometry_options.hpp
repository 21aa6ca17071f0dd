#pragma once

namespace evo {
class Parameters;
}

namespace evo::odometry {

// The parameters of the odometry with their defaults. Name, unit, range and meaning of each: Register().

/// Frames made from asynchronous tracks.
struct ResamplingOptions {
  double frame_interval_s = 0.025;
  double fit_window_s = 0.01;
  double max_gap_s = 0.2;
};

/// The first map from two frames.
struct BootstrapOptions {
  double min_disparity_px = 10.0;
  double max_disparity_px = 30.0;
  double inlier_px = 1.5;
  double min_inlier_ratio = 0.6;
  int min_inliers = 20;
  double min_shared_ratio = 0.5;
  double min_parallax_deg = 1.0;
  double median_depth = 10.0;
  bool refine = true;
};

/// The pose of one frame against the map.
struct PoseOptions {
  int iterations = 10;
  double inlier_px = 2.0;
  int min_inliers = 6;
  double min_inlier_ratio = 0.5;
};

/// The choice of key frames.
struct KeyFrameOptions {
  double translation = 0.1;
  double rotation_deg = 10.0;
  double disparity_px = 40.0;
  double min_shared_ratio = 0.8;
  double min_disparity_px = 3.0;
  int every_frames = 0;
};

/// The depth of features that are not in the map yet.
struct DepthFilterOptions {
  double pixel_noise = 0.5;
  double convergence = 60.0;
  double epipolar_px = 2.5;
  double min_inlier_ratio = 0.35;
  int max_age = 3;
};

/// The map and the bundle adjustment of its last key frames.
struct MapperOptions {
  bool window_refinement = true;
  int window = 8;
  int window_iterations = 6;
  double loss_px = 1.0;
  double update_px = 1.0;
  int old_key_frames = 6;
  int max_outliers = 4;
  DepthFilterOptions depth_filter;
};

/// Frame by frame: the pose thread and the depth thread.
struct FrameHandlerOptions {
  int lag = 2;
  BootstrapOptions bootstrap;
  PoseOptions pose;
  KeyFrameOptions key_frame;
  MapperOptions mapper;
};

/// Errors that all tracks share. The residuals of an adjustment do not show them, since the poses absorb them: they are
/// properties of tracker and sensor and are measured where the truth is known.
struct CovarianceOptions {
  double variance_inflation = 8.0;
  double rotation_bias_ratio = 0.001;
  int samples = 100;
};

/// The bundle adjustment of the whole run.
struct FinalRefinementOptions {
  bool enabled = true;
  double min_disparity_px = 1.5;
  double drift_variance_ratio = 0.04;
  double velocity_change_scale = 2.0;
  bool track_noise = true;
  int rounds = 3;
  int iterations = 4;
  double max_block_products = 4e6;
  CovarianceOptions covariance;
};

/// The scale from the height of the camera above the road.
struct GroundOptions {
  bool hold_height = true;
  double camera_height_m = 0.0;
  double scale_drift_ratio = 0.0;
  double common_sigma_ratio = 0.005;
  double max_lateral_ratio = 2.5;
  double roll_drift = 0.001;
  double min_path_heights = 10.0;
};

struct OdometryOptions {
  ResamplingOptions resampling;
  FrameHandlerOptions frame_handler;
  bool backward_tracking = true;
  FinalRefinementOptions final_refinement;
  GroundOptions ground;
};

/// Registers all parameters of the odometry, with their former names as aliases.
void Register(Parameters& parameters, OdometryOptions& options);

}  // namespace evo::odometry
