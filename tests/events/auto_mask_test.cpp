#include "evo/events/auto_mask.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <utility>

#include "events/noise_stream.hpp"
#include "evo/core/error.hpp"

namespace evo::events {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr double kFocusX = 82.0;
constexpr double kFocusY = 45.0;
constexpr int kEdge = 88;  // of the bonnet in the middle

using Region = std::function<bool(int, int)>;

bool Everywhere(int, int) { return true; }
/// A bonnet that falls off to its sides.
bool OnBonnet(int x, int y) { return y >= kEdge + 14.0 * std::pow((x - 80.0) / 80.0, 2); }
bool OffBonnet(int x, int y) { return !OnBonnet(x, y); }

/// Squares that flow away from a focus, brighter or darker than what they pass, seen within a region.
struct Flow {
  double focus_x = kFocusX;
  double focus_y = kFocusY;
  double rate = 1.5;  // 1/s: speed over the distance from the focus
  int squares = 150;
  double from_s = 0.0;
  double to_s = 6.0;
  Region region = Everywhere;
};

/// Events of a square where it enters and leaves pixels.
class Square {
 public:
  Square(int polarity, NoiseStream* stream) : polarity_(polarity), stream_(stream) {}

  void MoveTo(double t_s, double x, double y, const Region& region) {
    std::set<std::pair<int, int>> covered;
    for (int row = 0; row < kSize; ++row) {
      for (int column = 0; column < kSize; ++column) {
        covered.emplace(static_cast<int>(std::floor(x)) + column, static_cast<int>(std::floor(y)) + row);
      }
    }
    for (const auto& pixel : covered) {
      if (!covered_.contains(pixel)) Add(t_s, pixel, polarity_, region);
    }
    for (const auto& pixel : covered_) {
      if (!covered.contains(pixel)) Add(t_s, pixel, -polarity_, region);
    }
    covered_ = std::move(covered);
  }

 private:
  static constexpr int kSize = 12;

  void Add(double t_s, const std::pair<int, int>& pixel, int polarity, const Region& region) {
    const auto [x, y] = pixel;
    if (x >= 0 && x < kWidth && y >= 0 && y < kHeight && region(x, y)) stream_->Add(t_s, x, y, polarity);
  }

  int polarity_;
  NoiseStream* stream_;
  std::set<std::pair<int, int>> covered_;
};

void AddFlow(const Flow& flow, NoiseStream* stream) {
  std::uniform_real_distribution<double> direction(-3.1416, 3.1416);
  std::uniform_real_distribution<double> start(0.0, 1.0);
  for (int i = 0; i < flow.squares; ++i) {
    double t = flow.from_s;
    bool is_first = true;
    while (t < flow.to_s) {
      const double angle = direction(stream->random());
      double radius = is_first ? 4.0 * std::pow(25.0, start(stream->random())) : 4.0;
      is_first = false;
      Square square(stream->Sign(), stream);
      for (; radius < 140.0 && t < flow.to_s; t += 0.4 / (flow.rate * radius), radius += 0.4) {
        square.MoveTo(t, flow.focus_x + radius * std::cos(angle), flow.focus_y + radius * std::sin(angle), flow.region);
      }
    }
  }
}

AutoMask Find(const EventColumns& events, const AutoMaskOptions& options = {}) {
  const auto open = [&](const Interval& interval) -> std::unique_ptr<EventReader> {
    const TimeNs start = events.t.front();
    EventColumns part;
    for (std::size_t i = 0; i < events.size(); ++i) {
      const TimeNs t = events.t[i] - start;
      if (t < interval.from || (interval.to && t >= *interval.to)) continue;
      part.push_back(events.t[i], events.x[i], events.y[i], events.polarity[i]);
    }
    if (part.empty()) throw Error(ErrorKind::kNothingToDo, "no events");
    class Part : public VectorReader {
     public:
      Part(const EventColumns& part, TimeNs first, TimeNs last)
          : VectorReader(part, 5000), first_(first), last_(last) {}
      TimeNs first_stamp() const override { return first_; }
      TimeNs last_stamp() const override { return last_; }

     private:
      TimeNs first_;
      TimeNs last_;
    };
    return std::make_unique<Part>(part, start, events.t.back());
  };
  return FindAutoMask(open, {}, kWidth, kHeight, options);
}

/// Masked pixels of a region over all of it.
double MaskedRatio(const AutoMask& mask, const Region& region) {
  double masked = 0.0;
  double all = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (!region(x, y)) continue;
      all += 1.0;
      if (!mask.masked.empty()) masked += mask.masked[static_cast<std::size_t>(y * kWidth + x)];
    }
  }
  return masked / all;
}

void ExpectBonnet(const AutoMask& mask) {
  EXPECT_GT(MaskedRatio(mask, OnBonnet), 0.95) << mask.summary;
  EXPECT_LT(MaskedRatio(mask, OffBonnet), 0.05) << mask.summary;
  EXPECT_NE(mask.summary.find("% of the sensor (bottom "), std::string::npos) << mask.summary;
}

void ExpectNothing(const AutoMask& mask, const std::string& reason) {
  EXPECT_TRUE(mask.masked.empty()) << mask.summary;
  EXPECT_EQ(mask.area_ratio, 0.0);
  EXPECT_TRUE(mask.summary.starts_with("nothing: ")) << mask.summary;
  EXPECT_NE(mask.summary.find(reason), std::string::npos) << mask.summary;
}

TEST(AutoMask, BonnetThatMirrors) {
  NoiseStream stream(1);
  AddFlow({.region = OffBonnet}, &stream);
  // The mirrored scene flows more slowly, from another focus.
  AddFlow({.focus_y = 70.0, .rate = 0.8, .region = OnBonnet}, &stream);
  stream.AddShotNoise(kWidth, kHeight, 6.0, 0.5);
  ExpectBonnet(Find(stream.Sorted()));
}

TEST(AutoMask, BonnetWithoutEvents) {
  NoiseStream stream(2);
  AddFlow({.region = OffBonnet}, &stream);
  ExpectBonnet(Find(stream.Sorted()));
}

TEST(AutoMask, SlicesOfALongRecording) {
  NoiseStream stream(3);
  AddFlow({.region = OffBonnet}, &stream);
  AutoMaskOptions options;
  options.slices = 10;
  options.slice_s = 0.4;
  ExpectBonnet(Find(stream.Sorted(), options));
}

TEST(AutoMask, CoverOnTheRight) {
  const Region covered = [](int x, int) { return x >= 140; };
  NoiseStream stream(4);
  AddFlow({.region = [&](int x, int y) { return !covered(x, y); }}, &stream);
  const AutoMask mask = Find(stream.Sorted());
  EXPECT_GT(MaskedRatio(mask, covered), 0.95) << mask.summary;
  EXPECT_LT(MaskedRatio(mask, [&](int x, int y) { return !covered(x, y); }), 0.05);
  EXPECT_NE(mask.summary.find("right "), std::string::npos) << mask.summary;
}

TEST(AutoMask, NothingInAnOpenView) {
  NoiseStream stream(5);
  AddFlow({}, &stream);
  ExpectNothing(Find(stream.Sorted()), "no edge");
}

TEST(AutoMask, LanesOfAStraightDriveAreNone) {
  // A road without texture between kerbs, with two lanes, whose lines keep their place in the image. The sky is empty.
  const auto slope = [](int x, int y) { return (x - kFocusX) / std::max(1.0, y - kFocusY); };
  NoiseStream stream(6);
  AddFlow({.region =
               [&](int x, int y) {
                 const double s = slope(x, y);
                 const bool is_sky = y < kFocusY && std::abs(x - kFocusX) < kFocusY - y;
                 return !is_sky && (y < kFocusY || std::abs(s) > 2.0 || std::abs(std::abs(s) - 0.7) < 0.08);
               }},
          &stream);
  stream.AddShotNoise(kWidth, kHeight, 6.0, 0.5);
  ExpectNothing(Find(stream.Sorted()), "no edge");
}

TEST(AutoMask, ACoverOfHalfTheRunIsNone) {
  NoiseStream stream(7);
  AddFlow({.to_s = 3.0, .region = OffBonnet}, &stream);
  AddFlow({.from_s = 3.0}, &stream);
  ExpectNothing(Find(stream.Sorted()), "no edge");
}

TEST(AutoMask, ACameraAtRest) {
  NoiseStream stream(8);
  stream.AddShotNoise(kWidth, kHeight, 6.0, 2.0);
  AddFlow({.squares = 3}, &stream);  // few move
  ExpectNothing(Find(stream.Sorted()), "too little of the image moves");
}

TEST(AutoMask, ACameraThatVibratesInPlace) {
  NoiseStream stream(9);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  for (int i = 0; i < 60; ++i) {
    const double x = kWidth * place(stream.random());
    const double y = kHeight * place(stream.random());
    Square square(stream.Sign(), &stream);
    for (double t = 0.0; t < 4.0; t += 0.004) {
      square.MoveTo(t, x + 3.0 * std::sin(50.0 * t), y + 3.0 * std::cos(43.0 * t), OffBonnet);
    }
  }
  EXPECT_TRUE(Find(stream.Sorted()).masked.empty());
}

TEST(AutoMask, HotPixelsAreNone) {
  NoiseStream stream(10);
  AddFlow({}, &stream);
  std::uniform_int_distribution<int> column(0, kWidth - 1);
  std::uniform_int_distribution<int> row(90, kHeight - 1);
  for (int i = 0; i < 150; ++i) stream.AddPoisson(column(stream.random()), row(stream.random()), 0.0, 6.0, 100.0);
  ExpectNothing(Find(stream.Sorted()), "no edge");
}

TEST(AutoMask, TooShort) {
  NoiseStream stream(11);
  AddFlow({.to_s = 1.5, .region = OffBonnet}, &stream);
  ExpectNothing(Find(stream.Sorted()), "too short");
}

}  // namespace
}  // namespace evo::events
