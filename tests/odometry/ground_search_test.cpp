#include "odometry/scale/ground_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace evo::odometry {
namespace {

constexpr std::size_t kSections = 10;
constexpr double kHeight = 1.5;
constexpr double kNoise = 0.02;

class Observations {
 public:
  explicit Observations(unsigned seed) : random_(seed) {}

  /// A track at this depth below the path, with noise.
  void Add(double below, double lateral) {
    const double inverse_height = (1.0 + kNoise * std::normal_distribution<double>()(random_)) / below;
    list_.push_back({0.0, inverse_height, kNoise / below, lateral / below});
    sections_.section.push_back(list_.size() % kSections);
  }
  void AddRoad(int count, double roll) {
    for (int i = 0; i < count; ++i) {
      const double lateral = Uniform(-3.0, 3.0);
      Add(kHeight + roll * lateral, lateral);
    }
  }
  /// Anywhere between the ground and the camera.
  void AddObstacles(int count) {
    for (int i = 0; i < count; ++i) Add(Uniform(0.1, 1.0) * kHeight, Uniform(-3.0, 3.0));
  }
  double Uniform(double min, double max) { return std::uniform_real_distribution<double>(min, max)(random_); }

  FoundGround Search() {
    sections_.step_sigmas.assign(kSections - 1, 0.005);
    return SearchGround(list_, sections_);
  }

 private:
  std::mt19937 random_;
  std::vector<GroundObservation> list_;
  GroundSections sections_;
};

TEST(GroundSearch, FindsHeightAndRollAmongObstacles) {
  for (const double roll : {-0.04, 0.0, 0.05}) {
    Observations observations(1);
    observations.AddRoad(60, roll);
    observations.AddObstacles(60);
    const FoundGround ground = observations.Search();
    EXPECT_NEAR(ground.roll, roll, 0.011);
    EXPECT_GT(ground.evidence, 20.0);
    for (const double log : ground.log_inverse_heights) EXPECT_NEAR(log, -std::log(kHeight), 0.02);
  }
}

TEST(GroundSearch, TakesTheLowerOfTwoPlanes) {
  Observations observations(2);
  observations.AddRoad(40, 0.0);
  for (int i = 0; i < 60; ++i) observations.Add(kHeight - 0.3, observations.Uniform(1.5, 3.0));
  EXPECT_NEAR(observations.Search().log_inverse_heights[0], -std::log(kHeight), 0.03);
}

/// A bonnet mirrors what stands above the camera: its images seem to lie below the ground, at any depth.
TEST(GroundSearch, FindsTheGroundBesideMirrorImages) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Observations observations(seed);
    observations.AddRoad(60, 0.02);
    observations.AddObstacles(20);
    for (int i = 0; i < 120; ++i) observations.Add(observations.Uniform(1.0, 15.0), observations.Uniform(-3.0, 3.0));
    const FoundGround ground = observations.Search();
    EXPECT_GT(ground.evidence, 10.0) << seed;
    for (const double log : ground.log_inverse_heights) EXPECT_NEAR(log, -std::log(kHeight), 0.02) << seed;
  }
}

TEST(GroundSearch, HasNoEvidenceInMirrorImagesAlone) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Observations observations(seed);
    for (int i = 0; i < 120; ++i) observations.Add(observations.Uniform(1.0, 15.0), observations.Uniform(-3.0, 3.0));
    EXPECT_LT(observations.Search().evidence, 10.0) << seed;
  }
}

TEST(GroundSearch, HasNoEvidenceWithoutAGround) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Observations observations(seed);
    observations.AddObstacles(100);
    EXPECT_LT(observations.Search().evidence, 10.0) << seed;
  }
}

}  // namespace
}  // namespace evo::odometry
