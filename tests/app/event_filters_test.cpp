// Masks and hot pixels from the command line to the results.
#include <nlohmann/json.hpp>

#include "app/pipeline.hpp"
#include "evo/io/track_io.hpp"
#include "evo/report/png.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

class EventFiltersTest : public PipelineTest {
 protected:
  /// A mask of the bundled sequences' sensor that ignores all rows from `row` on.
  std::string WriteMask(int row, int width = 346, int height = 260) const {
    events::GreyImage image{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width * height), 0)};
    std::fill_n(image.grey.begin(), row * width, std::uint8_t{255});
    report::WritePng(folder / "mask.png", image);
    return " --mask " + Quote(folder / "mask.png");
  }
  nlohmann::json Manifest(const std::string& result) const {
    return nlohmann::json::parse(ReadFile(folder / result / "manifest.json"));
  }

  const std::string words_ = "track -q --no-plots --to 1.1 --events " + Quote(Sample());
};

TEST_F(EventFiltersTest, MaskedRowsHaveNoTracks) {
  ASSERT_EQ(Run(words_ + WriteMask(120) + Out("result")), 0) << err;
  for (const auto& observation : io::ReadTracks(folder / "result" / "tracks.txt")) EXPECT_LT(observation.y, 125.0);
  const auto manifest = Manifest("result");
  EXPECT_EQ(manifest["counts"]["masked_pixels"], 140 * 346);
  EXPECT_GT(manifest["counts"]["masked_events"], 10'000);
  EXPECT_EQ(manifest["inputs"][2]["role"], "mask");
  EXPECT_NE(out.find("mask "), std::string::npos) << out;
}

TEST_F(EventFiltersTest, WhiteMaskChangesNothing) {
  ASSERT_EQ(Run(words_ + Out("without")), 0) << err;
  ASSERT_EQ(Run(words_ + WriteMask(260) + Out("with")), 0) << err;
  ExpectSameBytes("without", "with", {"tracks.txt", "lifetime.csv"});
}

TEST_F(EventFiltersTest, SavedMaskCanBeGivenBack) {
  const std::string saved = Quote(folder / "saved.png");
  ASSERT_EQ(Run(words_ + WriteMask(120) + " --save-mask " + saved + Out("first")), 0) << err;
  ASSERT_EQ(Run(words_ + " --mask " + saved + Out("second")), 0) << err;
  ExpectSameBytes("first", "second", {"tracks.txt", "lifetime.csv"});
  EXPECT_EQ(Run(words_ + " --save-mask " + saved + Out("none")), 2);
  EXPECT_NE(err.find("--save-mask needs a mask"), std::string::npos) << err;
}

TEST_F(EventFiltersTest, AutoMaskSaysWhyThereIsNone) {
  const std::string saved = Quote(folder / "saved.png");
  ASSERT_EQ(Run(words_ + " --mask auto --save-mask " + saved + Out("auto")), 0) << err;
  const std::string summary = "auto: nothing: 1.1 s are too short to tell";
  EXPECT_NE(out.find("mask       " + summary + '\n'), std::string::npos) << out;
  EXPECT_EQ(Manifest("auto")["mask"], summary);
  EXPECT_EQ(Manifest("auto")["inputs"].size(), 2U);
  ASSERT_EQ(Run(words_ + " --mask " + saved + Out("given")), 0) << err;
  ExpectSameBytes("auto", "given", {"tracks.txt", "lifetime.csv"});
  EXPECT_EQ(Run("info --mask auto " + Quote(Sample())), 2);
  EXPECT_NE(err.find("--save-mask FILE"), std::string::npos) << err;
}

TEST_F(EventFiltersTest, SavedHotPixelsCanBeGivenBack) {
  const std::string file = Quote(folder / "hot.txt");
  ASSERT_EQ(Run(words_ + " --save-hot-pixels " + file + Out("found")), 0) << err;
  const auto found = Manifest("found");
  EXPECT_EQ(found["hot_pixels"].size(), found["counts"]["hot_pixels"]);
  EXPECT_GT(found["counts"]["hot_pixels"], 3);
  ASSERT_EQ(Run(words_ + " --set events.hot_pixels.detect=false --hot-pixels " + file + Out("given")), 0) << err;
  const auto given = Manifest("given");
  EXPECT_EQ(given["counts"]["hot_pixels"], found["counts"]["hot_pixels"]);
  EXPECT_GE(given["counts"]["hot_events"], found["counts"]["hot_events"]);
  ASSERT_EQ(Run(words_ + " --set events.hot_pixels.detect=false" + Out("off")), 0) << err;
  EXPECT_EQ(Manifest("off")["counts"]["hot_events"], 0);
  EXPECT_FALSE(Manifest("off").contains("hot_pixels"));
}

TEST_F(EventFiltersTest, InfoDescribesTheEventsOutsideTheMask) {
  ASSERT_EQ(Run("info " + Quote(Sample()) + WriteMask(120)), 0) << err;
  EXPECT_NE(out.find("0 to 119 px"), std::string::npos) << out;
  EXPECT_NE(out.find("% of the events"), std::string::npos) << out;
}

TEST_F(EventFiltersTest, UnusableFilesAreRefused) {
  const auto refused = [&](const std::string& option, const std::string& part) {
    EXPECT_EQ(Refusal(words_ + option + Out("result")), 4) << err;
    EXPECT_NE(err.find(part), std::string::npos) << err;
    EXPECT_EQ(CountFiles(folder / "result"), 0);
  };
  refused(WriteMask(100, 240, 180), "the mask has 240 x 180 px, the sensor 346 x 260");
  refused(WriteMask(0), "black everywhere");
  refused(" --mask " + Quote(folder / "none.png"), "none.png");
  refused(" --mask " + Quote(Write("text.png", "no image")), "text.png");
  refused(" --hot-pixels " + Quote(Write("hot.txt", "3 4\n346 0\n")), "hot.txt:2: the column '346'");
}

}  // namespace
}  // namespace evo::app
