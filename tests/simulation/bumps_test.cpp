#include "simulation/motion/bumps.hpp"

#include <gtest/gtest.h>

#include <string>

#include "evo/core/error.hpp"
#include "evo/core/parameters.hpp"
#include "evo/simulation/scene_options.hpp"

namespace evo::simulation {
namespace {

TEST(ParseBumpTimes, ReadsListsAndPeriods) {
  using Times = std::vector<double>;
  EXPECT_EQ(ParseBumpTimes("", 60.0), Times());
  EXPECT_EQ(ParseBumpTimes("52, 48.5,70", 60.0), (Times{48.5, 52.0})) << "in order, within the run";
  EXPECT_EQ(ParseBumpTimes("every 15", 60.0), (Times{15.0, 30.0, 45.0, 60.0}));
}

TEST(ParseBumpTimes, RejectsOtherTexts) {
  SceneOptions options;
  Parameters parameters;
  Register(parameters, options);
  parameters.Set("motion.vehicle.bumps_at_s=52,60");
  EXPECT_EQ(options.vehicle.bumps_at_s, "52,60");
  for (const std::string text : {"often", "every", "every 0", "every -1", "5,", ",5", "5;6", "-3", "nan", "1e400"}) {
    EXPECT_EQ(ParseBumpTimes(text, 60.0), std::nullopt) << text;
    EXPECT_THROW(parameters.Set("motion.vehicle.bumps_at_s=" + text), Error) << text;
  }
}

}  // namespace
}  // namespace evo::simulation
