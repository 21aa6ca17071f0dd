#include "tracking/detection/corner_detector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace evo::tracking {
namespace {

const auto kAny = [](const Eigen::Vector2d&) { return true; };

using Eigen::Vector2d;

cv::Mat Squares() {
  cv::Mat image = cv::Mat::zeros(120, 160, CV_32F);
  for (int y = 20; y < 110; y += 40) {
    for (int x = 20; x < 150; x += 40) image(cv::Rect(x, y, 18, 18)) = 4.0f;
  }
  return image;
}

std::vector<Vector2d> Detect(const cv::Mat& image, const std::vector<Vector2d>& taken, int count,
                             const TrackerOptions& options = {}, int threads = 2) {
  ThreadPool pool(threads);
  return DetectCorners(image, taken, count, 0.0, options, &pool, kAny);
}

TEST(DetectCorners, FindsTheCornersOfSquaresAndNothingElse) {
  const auto corners = Detect(Squares(), {}, 100);
  EXPECT_GE(corners.size(), 30u);
  for (const auto& corner : corners) {
    double nearest = 1e9;
    for (int y = 20; y < 110; y += 40) {
      for (int x = 20; x < 150; x += 40) {
        for (const auto& c : {Vector2d(x, y), Vector2d(x + 17, y), Vector2d(x, y + 17), Vector2d(x + 17, y + 17)}) {
          nearest = std::min(nearest, (c - corner).norm());
        }
      }
    }
    EXPECT_LT(nearest, 4.0) << corner.transpose();
  }
}

TEST(DetectCorners, KeepsTheSpacingToFeaturesAndToEachOther) {
  TrackerOptions options;
  options.corner_spacing_px = 15.0;
  options.corner_min_spacing_px = 9.0;
  const std::vector<Vector2d> taken = {{20, 20}, {77, 77}};
  const auto nearest = [&](const std::vector<Vector2d>& corners) {
    double distance = 1e9;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (const auto& point : taken) distance = std::min(distance, (corners[i] - point).norm());
      for (std::size_t j = 0; j < i; ++j) distance = std::min(distance, (corners[i] - corners[j]).norm());
    }
    return distance;
  };
  EXPECT_GE(nearest(Detect(Squares(), taken, 8, options)), 15.0);
  // The minimum spacing applies where the spacing leaves too few.
  const auto many = Detect(Squares(), taken, 100, options);
  EXPECT_GE(nearest(many), 9.0);
  EXPECT_LT(nearest(many), 15.0);
}

TEST(DetectCorners, SpreadsAFewOverTheWholeImage) {
  const auto corners = Detect(Squares(), {}, 12);
  ASSERT_EQ(corners.size(), 12u);
  const auto in = [&](double x0, double x1) {
    return std::ranges::count_if(corners, [&](const auto& c) { return c.x() >= x0 && c.x() < x1; });
  };
  EXPECT_GE(in(0, 53), 2);
  EXPECT_GE(in(53, 106), 2);
  EXPECT_GE(in(106, 160), 2);
}

TEST(DetectCorners, FindsNothingInAnEmptyImage) { EXPECT_TRUE(Detect(cv::Mat::zeros(50, 50, CV_32F), {}, 10).empty()); }

TEST(DetectCorners, LeavesOutUnwantedCorners) {
  cv::Mat image = cv::Mat::zeros(100, 100, CV_32F);
  for (const int x : {20, 60}) image(cv::Rect(x, 40, 20, 20)) = 5.0;
  const TrackerOptions options;
  ThreadPool pool(1);
  const auto corners = DetectCorners(image, {}, 20, 0.0, options, &pool,
                                     [](const Eigen::Vector2d& corner) { return corner.x() > 50.0; });
  ASSERT_FALSE(corners.empty());
  for (const auto& corner : corners) EXPECT_GT(corner.x(), 50.0);
}

TEST(DetectCorners, LeavesOutPatchesWithTooFewEvents) {
  cv::Mat image = Squares();
  image(cv::Rect(0, 0, 80, 120)) *= 0.1f;  // a corner's patch holds about 400 events, on the left 40
  TrackerOptions options;
  options.corner_quality_ratio = 0.0;
  ThreadPool pool(1);
  const auto corners = DetectCorners(image, {}, 100, 200.0, options, &pool, kAny);
  EXPECT_GE(corners.size(), 10u);
  for (const auto& corner : corners) EXPECT_GE(corner.x(), 70.0);
}

TEST(DetectCorners, TakesWeakCornersOnlyWhereStrongOnesAreTooFew) {
  cv::Mat image = Squares();
  image(cv::Rect(80, 0, 80, 120)) *= 0.4f;  // on the right
  const auto is_weak = [](const Vector2d& corner) { return corner.x() > 78.0; };
  TrackerOptions options;
  options.corner_quality_ratio = 0.5;
  options.corner_min_quality_ratio = 0.5;
  const auto strong = Detect(image, {}, 100, options);
  EXPECT_GE(strong.size(), 15u);
  EXPECT_EQ(std::ranges::count_if(strong, is_weak), 0);
  options.corner_min_quality_ratio = 0.001;
  EXPECT_EQ(Detect(image, {}, static_cast<int>(strong.size()), options), strong);
  const auto all = Detect(image, {}, 100, options);
  EXPECT_GE(std::ranges::count_if(all, is_weak), 15);
  EXPECT_EQ(std::vector<Vector2d>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(strong.size())), strong);
}

TEST(DetectCorners, FindsTheSameWithAnyNumberOfThreads) {
  EXPECT_EQ(Detect(Squares(), {}, 100, {}, 1), Detect(Squares(), {}, 100, {}, 3));
}

TEST(DetectCorners, FindsNothingInATinyImage) { EXPECT_TRUE(Detect(cv::Mat::ones(9, 9, CV_32F), {}, 10).empty()); }

}  // namespace
}  // namespace evo::tracking
