#include "evo/report/draw.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <set>

#include "evo/core/error.hpp"
#include "evo/report/png.hpp"
#include "report/fixtures.hpp"

namespace evo::report {
namespace {

constexpr Color kWhite{255, 255, 255};
constexpr Color kBlack{0, 0, 0};

/// Sum of ink over the canvas: 1 for each black pixel on white.
double Ink(const Canvas& canvas) {
  double ink = 0.0;
  for (std::size_t i = 0; i < canvas.rgb.size(); i += 3) ink += (255 - canvas.rgb[i]) / 255.0;
  return ink;
}

TEST(Draw, LinesAreAsLongAndAsWideAsTheyShould) {
  for (const double angle : {0.0, 0.3, 0.8, 1.5708}) {
    Canvas canvas(120, 120, kWhite);
    const Eigen::Vector2d half = 40.0 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    DrawLine(&canvas, Eigen::Vector2d(60, 60) - half, Eigen::Vector2d(60, 60) + half, kBlack, 3.0);
    EXPECT_NEAR(Ink(canvas), 80.0 * 3.0 + M_PI * 1.5 * 1.5, 4.0) << angle;
    EXPECT_EQ(canvas.At(60, 60), kBlack);
  }
}

TEST(Draw, CirclesAndDiscsHaveTheirArea) {
  Canvas canvas(100, 100, kWhite);
  DrawDisc(&canvas, {50, 50}, 20.0, kBlack);
  EXPECT_NEAR(Ink(canvas), M_PI * 400.0, 15.0);
  Canvas ring(100, 100, kWhite);
  DrawCircle(&ring, {50, 50}, 30.0, kBlack, 2.0);
  EXPECT_NEAR(Ink(ring), 2.0 * M_PI * 30.0 * 2.0, 10.0);
  EXPECT_EQ(ring.At(50, 50), kWhite);
}

TEST(Draw, WhatLiesOffTheCanvasIsCut) {
  Canvas canvas(10, 10, kWhite);
  DrawLine(&canvas, {-100, 5}, {100, 5}, kBlack, 1.0);
  DrawLine(&canvas, {-100, -50}, {100, -50}, kBlack, 1.0);
  DrawDisc(&canvas, {-30, 300}, 5.0, kBlack);
  EXPECT_EQ(canvas.At(0, 5), kBlack);
  EXPECT_EQ(canvas.At(9, 5), kBlack);
  EXPECT_EQ(canvas.At(5, 1), kWhite);
}

TEST(Draw, EventsFillTheirPixelInTheColourOfTheLast) {
  events::EventColumns events;
  events.push_back(0, 1, 2, 1);
  events.push_back(1, 1, 2, -1);
  events.push_back(2, 3, 0, 1);
  events.push_back(3, 9, 9, 1);  // off the sensor
  const Canvas canvas = DrawEvents(events, 4, 3, PolarityColors::kRedBlue, 2);
  EXPECT_EQ(canvas.width, 8);
  EXPECT_EQ(canvas.height, 6);
  for (const auto& [x, y] : {std::pair{2, 4}, {3, 4}, {2, 5}, {3, 5}}) {
    EXPECT_GT(canvas.At(x, y).blue, canvas.At(x, y).red);
  }
  EXPECT_GT(canvas.At(6, 0).red, canvas.At(6, 0).blue);
  EXPECT_EQ(canvas.At(0, 0), kWhite);
  const Canvas print = DrawEvents(events, 4, 3, PolarityColors::kLightDark);
  EXPECT_LT(print.At(1, 2).red, print.At(3, 0).red);
}

TEST(Draw, TracksAliveHaveADotAndATail) {
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

TEST(Draw, ATrackHasItsColourOnEventsAndInEveryPanelOfASheet) {
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
    panels.push_back(DrawEvents(events, 40, 30, PolarityColors::kRedBlue, 3));
    DrawTracks(&panels.back(), tracks, i * 25'000'000, {10, 0, 3});
  }
  const Canvas sheet = Sheet(panels, 2, 6);
  EXPECT_EQ(sheet.width, 2 * 120 + 6);
  EXPECT_EQ(sheet.height, 2 * 90 + 6);
  for (int i = 0; i < 4; ++i) {
    const int left = i % 2 * 126;
    const int top = i / 2 * 96;
    for (const int id : {5, 6}) {
      EXPECT_EQ(sheet.At(left + 3 * (5 + 8 * i) + 1, top + 30 * (id - 4) + 1), TrackColor(id)) << i;
    }
    for (int x = 0; x < 120; ++x) EXPECT_EQ(sheet.At(left + x, top), panels[i].At(x, 0));
  }
  for (int y = 0; y < sheet.height; ++y) EXPECT_EQ(sheet.At(120 + 3, y), sheet.At(120, 92)) << y;  // the gaps
}

TEST(Draw, LabelsAreBlackOnWhiteAndAsHighAsTheyShould) {
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

TEST(Draw, TrackColorsDifferAndStay) {
  std::set<std::tuple<int, int, int>> colors;
  for (int id = 0; id < 30; ++id) {
    const Color c = TrackColor(id);
    EXPECT_EQ(c, TrackColor(id));
    colors.insert({c.red, c.green, c.blue});
  }
  EXPECT_EQ(colors.size(), 30u);
}

using PngTest = ReportTest;

TEST_F(PngTest, ReadsBackAsItWasDrawn) {
  Canvas canvas(7, 5, kWhite);
  for (int i = 0; i < 5; ++i) canvas.Blend(i, i, {static_cast<std::uint8_t>(40 * i), 10, 200});
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
