#pragma once

#include <string>

namespace evo {
class Parameters;
}

namespace evo::simulation {

// The options of a scene file. Register gives each field's unit, range and meaning.

/// Names street.*.
struct StreetOptions {
  double road_width_m = 7.0;
  double parking_width_m = 2.2;
  double pavement_width_m = 2.0;
  double house_share = 0.85;
  double trees_per_100_m = 6.0;
  double canopy = 0.0;
  double poles_per_100_m = 4.0;
  double parked_cars_per_100_m = 6.0;
  double oncoming_cars_per_100_m = 0.5;
  double oncoming_car_speed_m_s = 9.0;
  int cars_ahead = 0;
  bool lorry = false;
  double pedestrians_per_100_m = 0.0;
  double crossing_pedestrians_per_100_m = 0.0;
  bool left_hand_traffic = false;
  double camera_lateral_m = 0.0;
  double road_contrast = 1.0;
  double facade_contrast = 1.0;
  double wetness = 0.0;
  std::string light = "day";
  double dusk_ambient = 0.15;
  double night_ambient = 0.02;
  double head_lamps = 12.0;
  double lamp_intensity = 6.0;  // radiance 0.12 of a white road below it
  double lamp_flicker_hz = 120.0;
  double lamp_flicker_depth = 0.5;
};

/// Names motion.vehicle.*.
struct VehicleOptions {
  double duration_s = 60.0;
  // Speed.
  double speed_m_s = 7.5;
  double acceleration_m_s2 = 1.5;
  double stop_every_s = 0.0;
  double stand_s = 2.0;
  double start_at_rest_s = 1.0;
  double turn_speed_m_s = 4.0;
  // Mount of the camera.
  double camera_height_m = 1.5;
  double camera_pitch_deg = 0.0;
  double camera_yaw_deg = 0.0;
  double camera_roll_deg = 0.0;
  // Bonnet.
  double bonnet_deg = 0.0;
  double bonnet_reflectivity = 0.05;
  double bonnet_paint = 0.1;
  // Vibration.
  double vibration_deg = 0.05;
  double vibration_hz = 12.0;
  // Bumps of the road.
  std::string bumps_at_s;
  double bump_pitch_deg = 2.0;
  double bump_heave_m = 0.06;
  double bump_roll_deg = 0.7;
};

/// Names motion.handheld.*.
struct HandheldOptions {
  double duration_s = 20.0;
  double translation_m = 0.3;
  double rotation_deg = 12.0;
  double frequency_hz = 0.5;
};

/// Names motion.slider.*.
struct SliderOptions {
  double duration_s = 3.0;
  double length_m = 0.6;
};

/// Names sensor.*. The defaults are a DAVIS346 as set up for the MVSEC drives, with about three negative events for
/// each positive one. They hold for day and night: the light makes the pixels slow and noisy.
struct SensorOptions {
  // Contrast thresholds.
  double threshold_on = 0.65;
  double threshold_off = 0.18;
  double threshold_spread = 0.03;
  // Photoreceptor.
  double bandwidth_hz = 300.0;
  double dark_bandwidth_hz = 10.0;
  double dark_radiance = 0.002;
  double refractory_s = 0.0005;
  // Noise.
  double leak_hz = 0.1;
  double shot_noise_hz = 0.5;
  double hot_pixels = 0.0002;
  double hot_rate_hz = 100.0;
  double hot_noisy = 0.0;
  double hot_intermittent = 0.0;
  double dead_pixels = 0.0002;
  // Readout.
  double readout_row_s = 0.0;
};

/// Names camera.*. They hold for scene.calibration: camera.
struct CameraOptions {
  int width_px = 346;
  int height_px = 260;
  double focal_px = 224.0;
  double centre_x_px = 0.0;
  double centre_y_px = 0.0;
  std::string distortion = "equidistant";
  double k1 = 0.0;
  double k2 = 0.0;
};

/// Names simulation.*.
struct SimulationOptions {
  // Rendering.
  int samples = 2;
  double max_step_px = 0.5;
  double max_step_s = 0.005;
  int tile_px = 16;
  double lead_in_s = 0.3;
  // Output.
  double image_hz = 20.0;
  double depth_hz = 20.0;
};

/// Everything that a scene file may set.
struct SceneOptions {
  int seed = 1;
  std::string kind = "street";
  std::string calibration = "davis346";
  std::string motion = "vehicle";
  std::string motion_file;
  std::string road_shape = "curved";
  double road_length_m = 0.0;
  double road_slope = 0.0;
  StreetOptions street;
  VehicleOptions vehicle;
  HandheldOptions handheld;
  SliderOptions slider;
  CameraOptions camera;
  SensorOptions sensor;
  SimulationOptions simulation;
};

/// Names scene.*, motion.*, road.* and the parameters of all parts.
void Register(Parameters& parameters, SceneOptions& options);

}  // namespace evo::simulation
