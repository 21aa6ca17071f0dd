#include "evo/simulation/scene_options.hpp"

#include <limits>

#include "evo/core/parameters.hpp"
#include "simulation/motion/bumps.hpp"

namespace evo::simulation {

namespace {

void Register(Parameters& p, StreetOptions& o) {
  p.Add("street.road_width_m", &o.road_width_m, 5.0, 20.0,
        "width of both lanes; the camera drives in the right one (m)");
  p.Add("street.parking_width_m", &o.parking_width_m, 0.0, 5.0, "width of the parking strip on each side (m)");
  p.Add("street.pavement_width_m", &o.pavement_width_m, 1.0, 10.0, "width of the pavement on each side (m)");
  p.Add("street.house_share", &o.house_share, 0.0, 1.0, "ratio of the road's length lined with houses");
  p.Add("street.trees_per_100_m", &o.trees_per_100_m, 0.0, 40.0, "trees on both sides together");
  p.Add("street.canopy", &o.canopy, 0.0, 1.0, "ratio of the trees whose crowns hang over the road");
  p.Add("street.poles_per_100_m", &o.poles_per_100_m, 0.0, 40.0, "street lamps, some with traffic signs");
  p.Add("street.parked_cars_per_100_m", &o.parked_cars_per_100_m, 0.0, 36.0,
        "parked cars on both sides together; a parking strip narrower than a car has none");
  p.Add("street.oncoming_cars_per_100_m", &o.oncoming_cars_per_100_m, 0.0, 12.0, "cars in the opposite lane");
  p.Add("street.oncoming_car_speed_m_s", &o.oncoming_car_speed_m_s, 0.0, 40.0, "speed of the oncoming cars (m/s)");
  p.Add("street.cars_ahead", &o.cars_ahead, 0, 20,
        "cars ahead in the camera's lane that drive as it does; motion.kind vehicle only");
  p.Add("street.lorry", &o.lorry,
        "a lorry that drives in the other lane, slowly past the camera; motion.kind vehicle only");
  p.Add("street.pedestrians_per_100_m", &o.pedestrians_per_100_m, 0.0, 20.0, "pedestrians on both pavements together");
  p.Add("street.crossing_pedestrians_per_100_m", &o.crossing_pedestrians_per_100_m, 0.0, 20.0,
        "pedestrians that cross ahead of the camera; motion.kind vehicle only");
  p.Add("street.left_hand_traffic", &o.left_hand_traffic, "the camera drives in the left lane");
  p.Add("street.camera_lateral_m", &o.camera_lateral_m, -2.0, 2.0,
        "offset of the camera from the centre of its lane, positive: to the right (m)");
  p.Add("street.road_contrast", &o.road_contrast, 0.0, 1.0,
        "contrast of asphalt, pavements and ground over that of worn ones; markings and kerbs keep theirs");
  p.Add("street.facade_contrast", &o.facade_contrast, 0.0, 1.0,
        "contrast of the facades over that of richly detailed ones");
  p.Add("street.wetness", &o.wetness, 0.0, 1.0,
        "how much the road mirrors the lamps, windows and the sky, as a ratio of what a wet one does");
  p.Add("street.light", &o.light, {"day", "dusk", "night"}, "dusk and night: street lamps, head lamps and lit windows");
  p.Add("street.dusk_ambient", &o.dusk_ambient, 0.0, 1.0, "ambient light at dusk over that of the day");
  p.Add("street.night_ambient", &o.night_ambient, 0.0, 1.0, "ambient light at night over that of the day");
  p.Add("street.head_lamps", &o.head_lamps, 0.0, 1000.0,
        "radiance of a white surface 1 m ahead of the camera at night");
  p.Add("street.lamp_intensity", &o.lamp_intensity, 0.0, 1000.0,
        "radiance of a white surface 1 m from a street lamp that it faces");
  p.Add("street.lamp_flicker_hz", &o.lamp_flicker_hz, 0.0, 1000.0, "flicker frequency of the street lamps (Hz)");
  p.Add("street.lamp_flicker_depth", &o.lamp_flicker_depth, 0.0, 0.99,
        "flicker of the street lamps: amplitude over the mean light");
}

void Register(Parameters& p, VehicleOptions& o) {
  const std::string prefix = "motion.vehicle.";
  const auto add = [&](const char* name, double* value, double lowest, double highest, const char* help) {
    p.Add(prefix + name, value, lowest, highest, help);
  };
  add("duration_s", &o.duration_s, 0.1, 36'000.0, "length of the run (s)");
  add("speed_m_s", &o.speed_m_s, 0.1, 40.0, "cruising speed (m/s)");
  add("acceleration_m_s2", &o.acceleration_m_s2, 0.1, 8.0, "maximum acceleration and deceleration (m/s^2)");
  add("stop_every_s", &o.stop_every_s, 0.0, 3600.0, "period at which the car brakes to a stop (s); 0: never");
  add("stand_s", &o.stand_s, 0.0, 3600.0, "length of a stop (s)");
  add("start_at_rest_s", &o.start_at_rest_s, 0.0, 3600.0,
      "length of the stand at the start (s); 0: starts at full speed");
  add("turn_speed_m_s", &o.turn_speed_m_s, 0.5, 40.0,
      "speed in right-angle turns; wider bends have the same lateral acceleration (m/s)");
  add("camera_height_m", &o.camera_height_m, 0.2, 5.0, "height of the camera above the road (m)");
  add("camera_pitch_deg", &o.camera_pitch_deg, -45.0, 45.0, "pitch of the camera, positive: looks down (degrees)");
  add("camera_yaw_deg", &o.camera_yaw_deg, -45.0, 45.0, "yaw of the camera, positive: looks to the right (degrees)");
  add("camera_roll_deg", &o.camera_roll_deg, -45.0, 45.0, "roll of the camera, positive: clockwise (degrees)");
  add("bonnet_deg", &o.bonnet_deg, 0.0, 45.0,
      "angle below the horizon at which the car's bonnet, which mirrors the scene, begins (degrees); 0: out of sight");
  add("bonnet_reflectivity", &o.bonnet_reflectivity, 0.0, 1.0,
      "reflectivity of the bonnet's clear coat at normal incidence; it grows to 1 at grazing angles");
  add("bonnet_paint", &o.bonnet_paint, 0.0, 1.0, "reflectance of the bonnet's paint");
  add("vibration_deg", &o.vibration_deg, 0.0, 5.0, "standard deviation of the vibration about each axis (degrees)");
  add("vibration_hz", &o.vibration_hz, 0.1, 100.0, "mean frequency of the vibration (Hz)");
  p.Add(
      prefix + "bumps_at_s", &o.bumps_at_s,
      [](const std::string& text) { return ParseBumpTimes(text, 0.0).has_value(); },
      "times in s (\"52,60\"), \"every 5\" (0.1 or more) or empty", "times of the road's bumps; empty: none");
  add("bump_pitch_deg", &o.bump_pitch_deg, 0.0, 20.0, "peak pitch of a bump (degrees)");
  add("bump_heave_m", &o.bump_heave_m, 0.0, 0.5, "peak heave of a bump (m)");
  add("bump_roll_deg", &o.bump_roll_deg, 0.0, 20.0, "peak roll of a bump, to a random side (degrees)");
}

void Register(Parameters& p, HandheldOptions& o) {
  p.Add("motion.handheld.duration_s", &o.duration_s, 0.1, 36'000.0, "length of the run (s)");
  p.Add("motion.handheld.translation_m", &o.translation_m, 0.0, 10.0,
        "standard deviation of the position on each axis (m)");
  p.Add("motion.handheld.rotation_deg", &o.rotation_deg, 0.0, 40.0,
        "standard deviation of the rotation about each axis (degrees)");
  p.Add("motion.handheld.frequency_hz", &o.frequency_hz, 0.01, 20.0, "maximum frequency of the motion (Hz)");
}

void Register(Parameters& p, SliderOptions& o) {
  p.Add("motion.slider.duration_s", &o.duration_s, 0.2, 36'000.0, "length of the run (s)");
  p.Add("motion.slider.length_m", &o.length_m, 0.0, 100.0, "distance along the camera's x axis (m)");
}

void Register(Parameters& p, SensorOptions& o) {
  p.Add("sensor.threshold_on", &o.threshold_on, 0.01, 10.0,
        "contrast threshold of positive events: change of log radiance, mean over the pixels");
  p.Add("sensor.threshold_off", &o.threshold_off, 0.01, 10.0, "contrast threshold of negative events");
  p.Add("sensor.threshold_spread", &o.threshold_spread, 0.0, 1.0,
        "threshold mismatch: standard deviation of both thresholds over the pixels");
  p.Add("sensor.bandwidth_hz", &o.bandwidth_hz, 0.0, 1e6,
        "cut-off frequency of the photoreceptor's low-pass at radiance 1 and above (Hz); 0: no low-pass");
  p.Add("sensor.dark_bandwidth_hz", &o.dark_bandwidth_hz, 0.01, 1e6,
        "cut-off frequency in the dark; it is proportional to radiance between the two (Hz)");
  p.Add("sensor.refractory_s", &o.refractory_s, 0.0, 1.0, "refractory period of a pixel after an event (s)");
  p.Add("sensor.leak_hz", &o.leak_hz, 0.0, 1000.0, "rate of leak events of a pixel that sees no change (Hz)");
  p.Add("sensor.shot_noise_hz", &o.shot_noise_hz, 0.0, 1000.0,
        "rate of shot noise events of a dark pixel; a pixel of radiance 1 has a quarter (Hz)");
  p.Add("sensor.hot_pixels", &o.hot_pixels, 0.0, 1.0, "ratio of hot pixels, which fire by themselves");
  p.Add("sensor.hot_rate_hz", &o.hot_rate_hz, 0.0, 1e5, "mean event rate of a hot pixel (Hz)");
  p.Add("sensor.hot_noisy", &o.hot_noisy, 0.0, 1.0,
        "ratio of the hot pixels that fire at random with both polarities; the others fire steadily, positive");
  p.Add("sensor.hot_intermittent", &o.hot_intermittent, 0.0, 1.0,
        "ratio of the hot pixels that come and go, for 1.5 s each on average");
  p.Add("sensor.dead_pixels", &o.dead_pixels, 0.0, 1.0, "ratio of pixels that never fire");
  p.Add("sensor.dark_radiance", &o.dark_radiance, 1e-6, 10.0, "dark current, as a radiance added to the scene's");
  p.Add("sensor.readout_row_s", &o.readout_row_s, 0.0, 0.1,
        "period of a row's readout, which stamps its events (s); 0: events are stamped at once");
}

void Register(Parameters& p, CameraOptions& o) {
  p.Add("camera.width_px", &o.width_px, 16, 2000, "width of the sensor (px)");
  p.Add("camera.height_px", &o.height_px, 16, 2000, "height of the sensor (px)");
  p.Add("camera.focal_px", &o.focal_px, 10.0, 5000.0, "focal length (px)");
  p.Add("camera.centre_x_px", &o.centre_x_px, -500.0, 500.0,
        "principal point from the middle of the sensor, positive: to the right (px)");
  p.Add("camera.centre_y_px", &o.centre_y_px, -500.0, 500.0, "the same, positive: downwards (px)");
  p.Add("camera.distortion", &o.distortion, {"radtan", "equidistant"}, "lens model");
  p.Add("camera.k1", &o.k1, -1.0, 1.0, "first coefficient of the lens model");
  p.Add("camera.k2", &o.k2, -1.0, 1.0, "second coefficient of the lens model");
}

void Register(Parameters& p, SimulationOptions& o) {
  p.Add("simulation.samples", &o.samples, 1, 8, "rays per pixel along each side");
  p.Add("simulation.max_step_px", &o.max_step_px, 0.05, 10.0, "maximum motion in a tile between two renders (px)");
  p.Alias("simulation.largest_step_px", "simulation.max_step_px");
  p.Add("simulation.max_step_s", &o.max_step_s, 1e-4, 0.01, "maximum time between two renders of a tile (s)");
  p.Alias("simulation.longest_step_s", "simulation.max_step_s");
  p.Add("simulation.tile_px", &o.tile_px, 4, 256, "side of the tiles, which have render rates of their own (px)");
  p.Add("simulation.lead_in_s", &o.lead_in_s, 0.0, 10.0,
        "time that the sensor sees the scene before the sequence begins, unless that is the scene's start (s)");
  p.Add("simulation.image_hz", &o.image_hz, 0.0, 1000.0, "rate of grey images (Hz); 0: none");
  p.Add("simulation.depth_hz", &o.depth_hz, 0.0, 1000.0, "rate of depth maps, about 0.2 MB each (Hz); 0: none");
}

}  // namespace

void Register(Parameters& p, SceneOptions& o) {
  const auto any = [](const std::string&) { return true; };
  const auto not_empty = [](const std::string& text) { return !text.empty(); };
  p.Add("scene.seed", &o.seed, 0, std::numeric_limits<int>::max(), "seed of all random numbers");
  p.Add("scene.kind", &o.kind, {"street", "room", "slider"}, "world");
  p.Add("motion.kind", &o.motion, {"vehicle", "handheld", "slider", "file"}, "motion of the camera");
  p.Add("motion.file", &o.motion_file, any, "path",
        "trajectory for kind: file (TUM text); a cubic spline passes through its poses");
  p.Add("scene.calibration", &o.calibration, not_empty, "davis346, davis240c, camera or the path of a calibration",
        "calibration of the camera; camera: as camera.* says");
  p.Add("road.shape", &o.road_shape, {"straight", "curved", "turns"}, "turns: right-angle turns at junctions");
  p.Add("road.length_m", &o.road_length_m, 0.0, 1e5, "length of the road (m); 0: as the motion needs");
  p.Add("road.slope", &o.road_slope, 0.0, 0.3, "maximum slope of the hills (rise over run)");
  Register(p, o.street);
  Register(p, o.vehicle);
  Register(p, o.handheld);
  Register(p, o.slider);
  Register(p, o.camera);
  Register(p, o.sensor);
  Register(p, o.simulation);
}

}  // namespace evo::simulation
