#include "tracking/detection/harris.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace evo::tracking {
namespace {

constexpr int kWidth = 60;
constexpr int kHeight = 50;
constexpr int kBorder = Harris::kBorderPx;

cv::Mat Texture() {
  cv::Mat image(kHeight, kWidth, CV_32F);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) image.at<float>(y, x) = static_cast<float>((x * x + 3 * x * y + 7 * y) % 11);
  }
  return image;
}

/// The response by definition, from sums over 7 x 7 px of the products of the smoothed root's Sobel gradients.
double Defined(const cv::Mat& image, int x, int y) {
  const auto smooth = [&](int u, int v) {
    double sum = 0.0, weights = 0.0;
    for (int dv = -3; dv <= 3; ++dv) {
      for (int du = -3; du <= 3; ++du) {
        const double weight = std::exp(-0.5 * (du * du + dv * dv));
        sum += weight * std::sqrt(image.at<float>(v + dv, u + du));
        weights += weight;
      }
    }
    return sum / weights;
  };
  double a = 0.0, b = 0.0, c = 0.0;
  for (int v = y - 3; v <= y + 3; ++v) {
    for (int u = x - 3; u <= x + 3; ++u) {
      double dx = 0.0, dy = 0.0;
      for (int i = -1; i <= 1; ++i) {
        dx += (2 - std::abs(i)) * (smooth(u + 1, v + i) - smooth(u - 1, v + i));
        dy += (2 - std::abs(i)) * (smooth(u + i, v + 1) - smooth(u + i, v - 1));
      }
      a += dx * dx;
      b += dx * dy;
      c += dy * dy;
    }
  }
  return a * c - b * b - 0.04 * (a + c) * (a + c);
}

TEST(Harris, MatchesTheDefinition) {
  const cv::Mat image = Texture();
  ThreadPool pool(2);
  Harris harris;
  harris.Respond(image, &pool);
  for (int y = kBorder; y < kHeight - kBorder; y += 5) {
    for (int x = kBorder; x < kWidth - kBorder; x += 3) {
      const double expected = Defined(image, x, y);
      EXPECT_NEAR(harris.row(y)[x], expected, 1e-3 * std::abs(expected) + 1e-2) << x << ' ' << y;
    }
  }
}

TEST(Harris, IsZeroAtTheBorderWhateverImageCameBefore) {
  ThreadPool pool(1);
  Harris harris;
  harris.Respond(Texture(), &pool);
  harris.Respond(Texture()(cv::Rect(0, 0, 40, 30)).clone(), &pool);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      if (x >= kBorder && y >= kBorder && x < 40 - kBorder && y < 30 - kBorder) continue;
      EXPECT_EQ(harris.row(y)[x], 0.0f) << x << ' ' << y;
    }
  }
}

}  // namespace
}  // namespace evo::tracking
