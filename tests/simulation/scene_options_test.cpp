#include "evo/simulation/scene_options.hpp"

#include <gtest/gtest.h>

#include "evo/core/error.hpp"
#include "evo/core/parameters.hpp"

namespace evo::simulation {
namespace {

TEST(SceneOptions, SensorParametersHaveRanges) {
  SceneOptions options;
  Parameters parameters;
  Register(parameters, options);
  parameters.Set("sensor.threshold_on=0.4");
  EXPECT_EQ(options.sensor.threshold_on, 0.4);
  for (const char* bad : {"sensor.threshold_on=0", "sensor.threshold_off=-0.1", "sensor.refractory_s=-1",
                          "sensor.dead_pixels=1.5", "sensor.dark_radiance=0", "sensor.leak_hz=nan"}) {
    EXPECT_THROW(parameters.Set(bad), Error) << bad;
  }
}

TEST(SceneOptions, FormerNamesOfParametersAreAccepted) {
  SceneOptions options;
  Parameters parameters;
  Register(parameters, options);
  parameters.Set("simulation.largest_step_px=0.25");
  parameters.Set("simulation.longest_step_s=0.002");
  EXPECT_EQ(options.simulation.max_step_px, 0.25);
  EXPECT_EQ(options.simulation.max_step_s, 0.002);
}

}  // namespace
}  // namespace evo::simulation
