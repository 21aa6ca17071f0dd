#include "evo/tracking/corner_detector.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace evo {

namespace {

constexpr int kHarrisBlockPx = 7;
constexpr double kHarrisK = 0.04;
constexpr double kStrongCorner = 0.95;  // quantile
constexpr int kBucketPx = 32;

struct Corner {
  float strength;
  int x, y;
};

std::vector<Corner> LocalMaxima(const cv::Mat& response, double border_px) {
  cv::Mat dilated;
  cv::dilate(response, dilated, cv::Mat());
  std::vector<Corner> corners;
  const int border = static_cast<int>(std::ceil(border_px)) + 2;
  for (int y = border; y < response.rows - border; ++y) {
    for (int x = border; x < response.cols - border; ++x) {
      const float strength = response.at<float>(y, x);
      if (strength > 0.0f && strength == dilated.at<float>(y, x)) corners.push_back({strength, x, y});
    }
  }
  // A total order, so that equal responses do not depend on the sort.
  std::ranges::sort(corners, [](const Corner& a, const Corner& b) {
    return std::tuple(-a.strength, a.y, a.x) < std::tuple(-b.strength, b.y, b.x);
  });
  return corners;
}

}  // namespace

cv::Mat CorrectedEventImage(const EventHistory& history, TimeNs t, const FlowField& flow, double motion_px,
                            const TrackerOptions& options) {
  cv::Mat image = cv::Mat::zeros(history.height(), history.width(), CV_32F);
  const TimeNs longest = FromSeconds(0.5 * options.longest_window_s);
  const double shortest_s = 0.5 * options.shortest_window_s;
  const double half_motion2 = 0.25 * motion_px * motion_px;
  history.ForEachBetween(t - longest, t + longest, [&](int ex, int ey, TimeNs et, std::int8_t) {
    const Eigen::Vector2d v = flow.At(ex, ey);
    const double dt = ToSeconds(et - t);
    // HalfWindow() without its root and quotient: most of the events end here.
    if (std::abs(dt) > shortest_s && dt * dt * v.squaredNorm() > half_motion2) return;
    const double x = ex - v.x() * dt;
    const double y = ey - v.y() * dt;
    const int c = static_cast<int>(std::floor(x));
    const int r = static_cast<int>(std::floor(y));
    if (c < 0 || r < 0 || c + 1 >= image.cols || r + 1 >= image.rows) return;
    const auto fx = static_cast<float>(x - c);
    const auto fy = static_cast<float>(y - r);
    float* row = image.ptr<float>(r);
    float* below = image.ptr<float>(r + 1);
    row[c] += (1 - fx) * (1 - fy);
    row[c + 1] += fx * (1 - fy);
    below[c] += (1 - fx) * fy;
    below[c + 1] += fx * fy;
  });
  return image;
}

std::vector<Eigen::Vector2d> DetectCorners(const cv::Mat& image, const std::vector<Eigen::Vector2d>& taken, int count,
                                           const TrackerOptions& options) {
  // The square root evens out pixels that fire often and pixels that fire once.
  cv::Mat smooth;
  cv::sqrt(image, smooth);
  cv::GaussianBlur(smooth, smooth, cv::Size(0, 0), 1.0);
  cv::Mat response;
  cv::cornerHarris(smooth, response, kHarrisBlockPx, 3, kHarrisK);
  const std::vector<Corner> corners = LocalMaxima(response, options.border_px);
  if (corners.empty()) return {};
  const auto strong = static_cast<std::size_t>((1.0 - kStrongCorner) * static_cast<double>(corners.size()));
  const auto weakest = static_cast<float>(options.corner_share * corners[strong].strength);

  const int columns = (image.cols + kBucketPx - 1) / kBucketPx;
  const int rows = (image.rows + kBucketPx - 1) / kBucketPx;
  std::vector<int> filled(static_cast<std::size_t>(columns * rows), 0);
  const auto bucket = [&](double x, double y) -> int& {
    return filled[static_cast<std::size_t>(static_cast<int>(y) / kBucketPx * columns +
                                           static_cast<int>(x) / kBucketPx)];
  };
  for (const auto& point : taken) ++bucket(point.x(), point.y());

  // Fill the emptiest buckets first: round n accepts only corners whose bucket holds fewer than n features.
  std::vector<Eigen::Vector2d> occupied = taken;
  std::vector<Eigen::Vector2d> found;
  const double spacing2 = options.corner_spacing_px * options.corner_spacing_px;
  const int most = kBucketPx * kBucketPx / std::max(1, static_cast<int>(spacing2)) + 1;
  std::vector<char> used(corners.size(), 0);
  for (int round = 1; round <= most && static_cast<int>(found.size()) < count; ++round) {
    for (std::size_t i = 0; i < corners.size() && static_cast<int>(found.size()) < count; ++i) {
      const Corner& corner = corners[i];
      if (corner.strength < weakest) break;
      if (used[i] || bucket(corner.x, corner.y) >= round) continue;
      const Eigen::Vector2d point(corner.x, corner.y);
      used[i] = 1;
      if (std::ranges::any_of(occupied, [&](const auto& o) { return (o - point).squaredNorm() < spacing2; })) continue;
      ++bucket(corner.x, corner.y);
      occupied.push_back(point);
      found.push_back(point);
    }
  }
  return found;
}

}  // namespace evo
