#include "evo/simulation/random_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>

#include "evo/core/error.hpp"
#include "evo/core/parameters.hpp"
#include "simulation/random_value.hpp"

namespace evo::simulation {
namespace {

std::string NoParameter(const std::string&) { return ""; }

std::string Draw(const std::string& text, std::uint64_t seed) {
  return RandomValue::Parse(text)->Draw(Random(seed), NoParameter);
}

TEST(RandomValue, AValueStaysAsItIs) {
  EXPECT_EQ(Draw("day", 1), "day");
  EXPECT_EQ(Draw("0.5", 2), "0.5");
  EXPECT_EQ(Draw("every 5", 3), "every 5");
  EXPECT_EQ(Draw("", 4), "");
}

TEST(RandomValue, ARangeIsUniform) {
  double sum = 0.0, low = 10.0, high = 0.0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const double value = std::stod(Draw("1..3", seed));
    sum += value, low = std::min(low, value), high = std::max(high, value);
  }
  EXPECT_NEAR(sum / 2000, 2.0, 0.05);
  EXPECT_GE(low, 1.0);
  EXPECT_LT(low, 1.05);
  EXPECT_LE(high, 3.0);
  EXPECT_GT(high, 2.95);
}

TEST(RandomValue, ALogarithmicRangeHasItsMedianInTheGeometricMean) {
  int below = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) below += std::stod(Draw("0.01..100 log", seed)) < 1.0 ? 1 : 0;
  EXPECT_NEAR(below, 1000, 100);
}

TEST(RandomValue, WholeNumbersIncludeBothEnds) {
  std::map<std::string, int> counts;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) ++counts[Draw("0..2 whole", seed)];
  EXPECT_EQ(counts.size(), 3u);
  for (const char* value : {"0", "1", "2"}) EXPECT_NEAR(counts[value], 1000, 150) << value;
}

TEST(RandomValue, AlternativesComeAsOftenAsTheirWeights) {
  std::map<std::string, int> counts;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) ++counts[Draw("none * 2 | 7 | every 4", seed)];
  EXPECT_NEAR(counts["none"], 2000, 200);
  EXPECT_NEAR(counts["7"], 1000, 150);
  EXPECT_NEAR(counts["every 4"], 1000, 150);
}

TEST(RandomValue, MultipliesWithAnotherParameter) {
  const auto lookup = [](const std::string& name) { return std::string(name == "a.b" ? "8" : "day"); };
  EXPECT_EQ(RandomValue::Parse("0.5 of a.b")->Draw(Random(1), lookup), "4");
  const double value = std::stod(RandomValue::Parse("1..2 log of a.b")->Draw(Random(1), lookup));
  EXPECT_GE(value, 8.0);
  EXPECT_LE(value, 16.0);
  EXPECT_THROW(RandomValue::Parse("0.5 of light")->Draw(Random(1), lookup), std::invalid_argument);
}

TEST(RandomValue, RefusesOtherForms) {
  for (const char* bad :
       {"3..1", "0..1 log", "-1..1 log", "day log", "1..2 * x", "a * -1", "a | ", "a * 0", "day of b"}) {
    EXPECT_FALSE(RandomValue::Parse(bad)) << bad;
  }
}

class RandomSceneTest : public ::testing::Test {
 protected:
  RandomSceneTest() { Register(parameters, options); }

  std::string Write(const std::string& text) const {
    const std::string path = ::testing::TempDir() + "random_scene_test.yaml";
    std::ofstream(path) << text;
    return path;
  }
  std::optional<DrawnNames> Load(const std::string& text, std::optional<int> seed) {
    return LoadScene(Write(text), seed, &options, &parameters);
  }
  std::string Refusal(const std::string& text) {
    try {
      Load(text, 1);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kConfiguration);
      return error.what();
    }
    ADD_FAILURE() << "accepted: " << text;
    return "";
  }

  SceneOptions options;
  Parameters parameters;
};

constexpr const char* kScene =
    "scene:\n  kind: street\nstreet.house_share: 0.5\n"
    "draw:\n"
    "  sensor.threshold_off: 0.1..0.3\n"
    "  sensor.threshold_on: 2..3 of sensor.threshold_off\n"
    "  light:\n"
    "    day: {weight: 3, street.light: day}\n"
    "    night: {street.light: night, street.night_ambient: 0.01..0.02}\n"
    "  motion.vehicle.speed_m_s: 5..10\n";

TEST_F(RandomSceneTest, TheSeedDrawsEverything) {
  const auto drawn = Load(kScene, 5);
  ASSERT_TRUE(drawn);
  ASSERT_EQ(drawn->size(), 1u);
  EXPECT_EQ(drawn->front().first, "light");
  EXPECT_EQ(drawn->front().second, options.street.light);
  EXPECT_EQ(options.seed, 5);
  EXPECT_EQ(options.street.house_share, 0.5);
  EXPECT_GE(options.sensor.threshold_on, 2.0 * options.sensor.threshold_off);
  EXPECT_LE(options.sensor.threshold_on, 3.0 * options.sensor.threshold_off * 1.001);
  const std::string first = parameters.ToYaml();
  Load(kScene, 6);
  EXPECT_NE(parameters.ToYaml(), first);
  Load(kScene, 5);
  EXPECT_EQ(parameters.ToYaml(), first);
}

TEST_F(RandomSceneTest, AnotherLineLeavesTheOtherValuesAlone) {
  Load(kScene, 7);
  const double speed = options.vehicle.speed_m_s;
  const std::string light = options.street.light;
  Load(std::string(kScene) + "  road.slope: 0..0.1\n", 7);
  EXPECT_EQ(options.vehicle.speed_m_s, speed);
  EXPECT_EQ(options.street.light, light);
  EXPECT_GT(options.road_slope, 0.0);
}

TEST_F(RandomSceneTest, ADrawnSceneReadsBackAsTheSame) {
  Load(kScene, 8);
  const std::string yaml = parameters.ToYaml();
  options = SceneOptions();
  EXPECT_FALSE(Load(yaml, std::nullopt)) << "nothing is drawn";
  EXPECT_EQ(parameters.ToYaml(), yaml);
}

TEST_F(RandomSceneTest, ErrorsNameTheLine) {
  EXPECT_NE(Refusal("draw:\n  sensor.threshold_on: 3..1\n").find("yaml:2"), std::string::npos);
  EXPECT_NE(Refusal("draw:\n  sensor.threshold_in: 1..3\n").find("sensor.threshold_on"), std::string::npos);
  EXPECT_NE(Refusal("draw:\n  sensor.threshold_on: 20..30\n").find("yaml:2"), std::string::npos);
  EXPECT_NE(Refusal("draw:\n  sensor.threshold_on: 2 of x.y\n").find("x.y"), std::string::npos);
  EXPECT_NE(Refusal("draw:\n  light:\n    day: {weight: 0, street.light: day}\n").find("weight"), std::string::npos);
  EXPECT_NE(Refusal("draw: 5\n").find("name: value"), std::string::npos);
  EXPECT_NE(Refusal("scene.seed: 1\nscene: {seed: 2}\ndraw: {road.slope: 0..0.1}\n").find("yaml:2"), std::string::npos)
      << "comes twice";
}

}  // namespace
}  // namespace evo::simulation
