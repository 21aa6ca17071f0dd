#pragma once

#include <string>

#include "evo/core/parameters.hpp"

namespace evo::tracking {

/// Parameters of the baseline, KLT on event images. Register() describes each of them.
struct KltOptions {
  int events = 30000;
  double max_window_s = 0.1;
  int patch_radius_px = 10;
  double forward_backward_px = 1.0;
};

/// Parameters of the feature tracker (A. Z. Zhu, N. Atanasov, K. Daniilidis: Event-Based Feature Tracking with
/// Probabilistic Data Association, ICRA 2017). Register() describes each of them. One set serves all data sets.
struct TrackerOptions {
  std::string method = "em";
  double frame_interval_s = 0.02;

  // Features.
  int features = 150;
  double refill_below = 0.97;
  int frames_between_refills = 5;
  int flow_patch_radius_px = 15;
  int patch_radius_px = 8;

  // Window of events of a feature.
  double window_motion_px = 5.0;
  double window_curvature_px = 0.15;
  double min_window_s = 0.004;
  double max_window_s = 0.08;
  int min_events = 50;
  int min_events_established = 15;
  double resting_flow_px_s = 20.0;
  int max_events = 250;

  // Expectation maximisation.
  double flow_sigma_px = 1.5;
  double coarse_sigma_px = 2.5;
  double fine_sigma_px = 0.75;
  double outlier_density_ratio = 0.2;
  int iterations = 20;
  double flow_prior = 8.0;
  double affine_prior = 20.0;
  double template_gain = 0.1;
  bool use_polarity = true;
  bool predict_polarity = true;

  // Motion of the camera.
  bool ego_motion = true;
  bool rotation_correction = true;
  bool rotation_spline = true;
  bool epipolar_filter = true;

  // Loss of a feature.
  double min_inlier_ratio = 0.3;
  double min_log_likelihood_ratio = 0.3;
  double max_residual_px = 2.0;
  double max_prediction_error_px = 6.0;
  double innovation_gate = 6.0;
  double min_innovation_gate_px = 0.5;
  double max_scale = 3.0;
  double border_px = 3.0;

  // Corners and new features.
  double corner_spacing_px = 10.0;
  double corner_min_spacing_px = 6.0;
  double corner_quality_ratio = 0.05;
  double corner_min_quality_ratio = 0.02;
  double corner_window_motion_px = 3.0;
  double uninformative_ratio = 0.45;
  double rejection_ratio = 0.03;
  double min_expected_lifetime_s = 0.12;
  double min_template_area_px = 8.0;

  KltOptions klt;
};

/// Registers all parameters of the tracker, with unit, range and meaning.
void Register(Parameters& parameters, TrackerOptions& options);

}  // namespace evo::tracking
