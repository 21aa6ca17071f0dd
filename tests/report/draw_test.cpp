#include "evo/report/draw.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <set>

#include "evo/core/error.hpp"
#include "evo/report/png.hpp"
#include "report/fixtures.hpp"

namespace evo::report {
namespace {

constexpr Color kWhite{255, 255, 255};
constexpr Color kBlack{0, 0, 0};

TEST(Draw, EventsFillTheirPixelWithTheColourOfTheLast) {
  events::EventColumns events;
  events.push_back(0, 1, 2, 1);
  events.push_back(1, 1, 2, -1);
  events.push_back(2, 3, 0, 1);
  events.push_back(3, 9, 9, 1);  // off the sensor
  const Canvas canvas = DrawEvents(events, 4, 3, 2);
  EXPECT_EQ(canvas.width, 8);
  EXPECT_EQ(canvas.height, 6);
  for (const auto& [x, y] : {std::pair{2, 4}, {3, 4}, {2, 5}, {3, 5}}) {
    EXPECT_GT(canvas.At(x, y).blue, canvas.At(x, y).red);
  }
  EXPECT_GT(canvas.At(6, 0).red, canvas.At(6, 0).blue);
  EXPECT_EQ(canvas.At(0, 0), kWhite);
}

TEST(Draw, LiveTracksHaveADotAndATail) {
  events::Tracks tracks;
  for (int i = 0; i <= 10; ++i) {
    if (i <= 5) tracks.push_back({1, i * 25'000'000, 5.0 + 2 * i, 10.0});  // over after frame 5
    tracks.push_back({2, i * 25'000'000, 5.0 + 4 * i, 30.0});
  }
  Canvas canvas(64, 64, kWhite);
  DrawTracks(&canvas, tracks, 10 * 25'000'000, {3, 50'000'000, 1});
  EXPECT_EQ(canvas.At(45, 30), TrackColor(2));
  EXPECT_NE(canvas.At(37, 30), kWhite);  // within the tail of three positions, 33 to 45
  EXPECT_EQ(canvas.At(29, 30), kWhite);
  for (int x = 0; x < 64; ++x) EXPECT_EQ(canvas.At(x, 10), kWhite);
  Canvas early(64, 64, kWhite);
  DrawTracks(&early, tracks, 5 * 25'000'000, {3, 50'000'000, 1});
  EXPECT_EQ(early.At(15, 10), TrackColor(1));
  EXPECT_EQ(early.At(45, 30), kWhite);  // what is yet to come
}

TEST(Draw, TracksOffTheCanvasAreClipped) {
  const events::Tracks tracks{{1, 0, -500.0, 10.0}, {2, 0, 30.0, 400.0}, {1, 1, 500.0, 10.0}};
  Canvas canvas(20, 20, kWhite);
  DrawTracks(&canvas, tracks, 1, {3, 50'000'000, 1});
  EXPECT_NE(canvas.At(0, 10), kWhite);
  EXPECT_NE(canvas.At(19, 10), kWhite);
  EXPECT_EQ(canvas.At(10, 15), kWhite);
}

TEST(Draw, TracksKeepTheirColourInEveryPanelOfAGrid) {
  events::EventColumns events;
  for (std::uint16_t x = 0; x < 40; ++x) {
    for (std::uint16_t y = 0; y < 30; ++y) events.push_back(x, x, y, x % 2 ? 1 : -1);
  }
  events::Tracks tracks;
  for (int i = 0; i < 4; ++i) {
    for (const int id : {5, 6}) tracks.push_back({id, i * 25'000'000, 5.0 + 8 * i, 10.0 * (id - 4)});
  }
  std::vector<Canvas> panels;
  for (int i = 0; i < 4; ++i) {
    panels.push_back(DrawEvents(events, 40, 30, 3));
    DrawTracks(&panels.back(), tracks, i * 25'000'000, {10, 0, 3});
  }
  const Canvas grid = ComposeGrid(panels, 2, 6);
  EXPECT_EQ(grid.width, 2 * 120 + 6);
  EXPECT_EQ(grid.height, 2 * 90 + 6);
  for (int i = 0; i < 4; ++i) {
    const int left = i % 2 * 126;
    const int top = i / 2 * 96;
    for (const int id : {5, 6}) {
      EXPECT_EQ(grid.At(left + 3 * (5 + 8 * i) + 1, top + 30 * (id - 4) + 1), TrackColor(id)) << i;
    }
    for (int x = 0; x < 120; ++x) EXPECT_EQ(grid.At(left + x, top), panels[i].At(x, 0));
  }
  for (int y = 0; y < grid.height; ++y) EXPECT_EQ(grid.At(120 + 3, y), grid.At(120, 92)) << y;  // the gaps
}

TEST(Draw, LabelsAreBlackOnWhiteOfTheGivenHeight) {
  constexpr Color kRed{255, 0, 0};
  Canvas canvas(300, 80, kRed);
  DrawLabel(&canvas, 10, 20, "t = 1.250 s", 24);
  int low = 80;
  int high = 0;
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 300; ++x) {
      if (canvas.At(x, y) != kBlack) continue;
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  EXPECT_NEAR(high - low, 24, 4);
  EXPECT_EQ(canvas.At(11, 21), kWhite);
  EXPECT_EQ(canvas.At(9, 40), kRed);
  EXPECT_EQ(canvas.At(11, 19), kRed);
  DrawLabel(&canvas, 290, 70, "cut off at the edge", 24);
}

TEST(Draw, TrackColorsAreDistinctAndStable) {
  std::set<std::tuple<int, int, int>> colors;
  for (int id = 0; id < 30; ++id) {
    const Color c = TrackColor(id);
    EXPECT_EQ(c, TrackColor(id));
    colors.insert({c.red, c.green, c.blue});
  }
  EXPECT_EQ(colors.size(), 30u);
}

using PngTest = ReportTest;

TEST_F(PngTest, ReadsBackAsDrawn) {
  Canvas canvas(7, 5, kWhite);
  for (int i = 0; i < 5; ++i) canvas.Set(i, i, {static_cast<std::uint8_t>(40 * i), 10, 200});
  WritePng(folder / "deep" / "image.png", canvas);

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&image, (folder / "deep" / "image.png").c_str()));
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(image));
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr));
  EXPECT_EQ(image.width, 7u);
  EXPECT_EQ(rgb, canvas.rgb);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "deep"), {}), 1);
}

TEST_F(PngTest, CannotWriteIsAnOutputError) {
  std::filesystem::create_directories(folder / "taken.png" / "by a folder");
  EXPECT_THROW(WritePng(folder / "taken.png", Canvas(2, 2, kWhite)), Error);
}

}  // namespace
}  // namespace evo::report
