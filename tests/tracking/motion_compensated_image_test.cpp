#include "tracking/detection/motion_compensated_image.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "tracking/synthetic_events.hpp"

namespace evo::tracking {
namespace {

using Eigen::Vector2d;

constexpr TimeNs kStamp = 100'000'000;

/// Sum of squares over the square of the sum.
double Contrast(const cv::Mat& image) {
  double squares = 0, sum = 0;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      squares += image.at<float>(y, x) * image.at<float>(y, x);
      sum += image.at<float>(y, x);
    }
  }
  return squares / (sum * sum);
}

class MotionCompensatedImageTest : public ::testing::Test {
 protected:
  MotionCompensatedImageTest() {
    history.Append(scene.Events([](double t) { return Vector2d(Vector2d(150.0, 150.0) * (t - 0.1)); }, 0.2, 1000.0));
    ThreadPool pool(1);
    flow.Update(
        history, kStamp, {}, [](const Vector2d&) { return std::nullopt; }, &pool);
  }

  cv::Mat Compensated(int threads) const {
    ThreadPool pool(threads);
    return MotionCompensatedImage(history, kStamp, flow, 8.5, options, &pool);
  }

  evo::tracking::testing::CrossScene scene{40, 2};
  TrackerOptions options;
  events::EventHistory history{scene.width, scene.height};
  FlowField flow{scene.width, scene.height, options};
};

TEST_F(MotionCompensatedImageTest, IsSharperThanTheRawImage) {
  cv::Mat raw = cv::Mat::zeros(scene.height, scene.width, CV_32F);
  history.ForEachBetween(kStamp - 20'000'000, kStamp + 20'000'000,
                         [&](int x, int y, TimeNs, std::int8_t) { raw.at<float>(y, x) += 1.0f; });
  EXPECT_GT(Contrast(Compensated(1)), 1.5 * Contrast(raw));
}

TEST_F(MotionCompensatedImageTest, IsTheSameForAnyNumberOfThreads) {
  EXPECT_EQ(cv::countNonZero(Compensated(1) != Compensated(3)), 0);
}

}  // namespace
}  // namespace evo::tracking
