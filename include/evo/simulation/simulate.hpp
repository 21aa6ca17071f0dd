#pragma once

#include <cstddef>
#include <cstdint>

#include "evo/core/parallel.hpp"
#include "evo/core/parameters.hpp"
#include "evo/core/progress.hpp"
#include "evo/core/time.hpp"
#include "evo/events/depth_map.hpp"
#include "evo/events/event_columns.hpp"
#include "evo/events/grey_image.hpp"
#include "evo/geometry/camera.hpp"
#include "evo/simulation/event_sensor.hpp"
#include "evo/simulation/scene.hpp"

namespace evo::simulation {

struct SimulationOptions {
  int samples = 2;                ///< rays a pixel, along each side
  double largest_step_px = 0.5;   ///< motion between two renders of a tile
  double longest_step_s = 0.005;  ///< between two renders of a tile in which nothing moves
  int tile_px = 16;
  /// The camera sees the scene so long before the sequence begins, as far as the scene reaches back: a sensor that is
  /// switched on with it would not lag yet, and its first positions would lead by up to as much as dark pixels are
  /// slow.
  double lead_in_s = 0.3;
  double image_hz = 20.0;  ///< grey images a second; 0: none
  double depth_hz = 20.0;  ///< depth maps a second; 0: none
};

void Register(Parameters& parameters, SimulationOptions& options);

/// Receives what the simulated camera delivers: events in the order (t, y, x), slab of time by slab; after a slab's
/// events its images, then its depth maps. Times since the start of the run.
class SimulationSink {
 public:
  virtual ~SimulationSink() = default;
  /// The next events; may be none.
  virtual void OnEvents(const events::EventColumns& events) = 0;
  /// `events_before` of all events so far have stamps before `t`.
  virtual void OnImage(TimeNs t, const events::GreyImage& image, std::size_t events_before) = 0;
  virtual void OnDepth(TimeNs t, const events::DepthMap& depth) = 0;
};

struct SimulationCounts {
  std::size_t events = 0;
  std::size_t positive = 0;       ///< of them
  std::size_t pixel_renders = 0;  ///< for events, pixels summed over the renders
  std::size_t images = 0;
  std::size_t depth_maps = 0;
};

/// What `camera` with an event sensor sees of `scene` on its way along `motion` during [0, duration), having looked
/// since -`lead_in`, from where on `motion` must be known, too. The tiles of the image are rendered at a rate of their
/// own, so that nothing in them moves more than `largest_step_px` from one render to the next; between two renders the
/// light changes linearly but for the lamps' flicker, which the sensor sees in full. Images and depth maps are rendered
/// at their exact times. The result depends on `seed` and the options alone, not on how many threads `pool` has.
/// `progress` may be null.
SimulationCounts Simulate(const Scene& scene, const geometry::Camera& camera, const CameraMotion& motion,
                          TimeNs lead_in, TimeNs duration, const SensorOptions& sensor,
                          const SimulationOptions& options, std::uint64_t seed, ThreadPool* pool, Progress* progress,
                          SimulationSink* sink);

}  // namespace evo::simulation
