#pragma once

#include <cstddef>

#include "evo/core/time.hpp"
#include "evo/events/depth_map.hpp"
#include "evo/events/event_columns.hpp"
#include "evo/events/grey_image.hpp"
#include "evo/simulation/scene_options.hpp"
#include "evo/simulation/simulated_run.hpp"

namespace evo {
class Progress;
class ThreadPool;
}  // namespace evo

namespace evo::simulation {

/// Receives the output of the simulated camera in batches of 10 ms: a batch's events in the order (t, y, x), then its
/// images, then its depth maps. Times count from the start of the run.
class SimulationSink {
 public:
  virtual ~SimulationSink() = default;
  /// The next events; may be empty.
  virtual void OnEvents(const events::EventColumns& events) = 0;
  /// `events_before` is the number of events so far that are stamped before `t`.
  virtual void OnImage(TimeNs t, const events::GreyImage& image, std::size_t events_before) = 0;
  virtual void OnDepth(TimeNs t, const events::DepthMap& depth) = 0;
};

struct SimulationCounts {
  std::size_t events = 0;
  std::size_t positive = 0;       ///< events of positive polarity
  std::size_t pixel_renders = 0;  ///< pixels summed over the renders for events
  std::size_t images = 0;
  std::size_t depth_maps = 0;
};

/// Simulates `run` with the seed, the sensor and the simulation options of `options`.
///
/// The sensor sees the scene for simulation.lead_in_s before the run begins, as far as the run reaches back: a sensor
/// that starts with the run has no low-pass lag yet, so that its first events come too early. The tiles of the image
/// are rendered at rates of their own, so that nothing in a tile moves by more than max_step_px between two renders
/// (adaptive sampling as in H. Rebecq et al., ESIM, CoRL 2018). Radiance is linear in time between two renders but for
/// the lamps' flicker, which the sensor sees in full. Images and depth maps are rendered at their exact times.
///
/// The result does not depend on the number of threads in `pool`. `progress` may be null.
SimulationCounts Simulate(const SimulatedRun& run, const SceneOptions& options, ThreadPool* pool, SimulationSink* sink,
                          Progress* progress = nullptr);

}  // namespace evo::simulation
