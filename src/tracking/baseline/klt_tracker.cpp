#include "tracking/baseline/klt_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "tracking/detection/corner_detector.hpp"

namespace evo::tracking {

namespace {

constexpr int kLevels = 3;            // below the full resolution
constexpr double kSmoothingPx = 1.0;  // events are grainy
constexpr double kWhite = 6.0;        // events in a pixel
constexpr double kBorderPx = 6.0;
constexpr std::size_t kFeaturesAJob = 16;

/// The 8-bit image that KLT wants. The square root evens out pixels that fire often and pixels that fire once.
cv::Mat Gray(const cv::Mat& events) {
  cv::Mat smooth, gray;
  cv::sqrt(events, smooth);
  cv::GaussianBlur(smooth, smooth, cv::Size(0, 0), kSmoothingPx);
  smooth.convertTo(gray, CV_8U, 255.0 / std::sqrt(kWhite));
  return gray;
}

}  // namespace

KltTracker::KltTracker(int width, int height, const TrackerOptions& options, ThreadPool* pool)
    : options_(options),
      width_(width),
      height_(height),
      patch_(2 * options.klt.patch_radius_px + 1, 2 * options.klt.patch_radius_px + 1),
      pool_(pool),
      refill_(options) {
  // Its larger patches would overlap too much, or stick out too far.
  options_.corner_min_spacing_px = options_.corner_spacing_px;
  options_.border_px = std::max(options_.border_px, kBorderPx);
}

cv::Mat KltTracker::EventImage(const events::EventHistory& history, TimeNs t) const {
  cv::Mat image = cv::Mat::zeros(history.height(), history.width(), CV_32F);
  const TimeNs newest = history.BeginOfNewest(t - before(), t, static_cast<std::size_t>(options_.klt.events));
  history.ForEachBetween(std::max(newest, t - before()), t,
                         [&](int x, int y, TimeNs, std::int8_t) { image.at<float>(y, x) += 1.0f; });
  return image;
}

void KltTracker::Process(const events::EventHistory& history, TimeNs t, const std::function<void()>& /*read_ahead*/) {
  const cv::Mat events = EventImage(history, t);
  std::vector<cv::Mat> pyramid;
  cv::buildOpticalFlowPyramid(Gray(events), pyramid, patch_, kLevels);
  if (!features_.empty()) Follow(pyramid);
  pyramid_ = std::move(pyramid);
  last_ = t;
  detected_ = refill_.IsDue(features_.size());
  if (detected_) Refill(events);
}

void KltTracker::Follow(const std::vector<cv::Mat>& pyramid) {
  const double b = options_.border_px;
  const auto inside = [&](const cv::Point2f& p) {
    return p.x >= b && p.y >= b && p.x <= width_ - 1 - b && p.y <= height_ - 1 - b;
  };
  pool_->ForEach((features_.size() + kFeaturesAJob - 1) / kFeaturesAJob, [&](std::size_t job) {
    const std::size_t first = job * kFeaturesAJob;
    const std::size_t end = std::min(first + kFeaturesAJob, features_.size());
    std::vector<cv::Point2f> before, now, back;
    std::vector<unsigned char> found, found_back;
    for (std::size_t i = first; i < end; ++i) before.push_back(features_[i].position);
    cv::calcOpticalFlowPyrLK(pyramid_, pyramid, before, now, found, cv::noArray(), patch_, kLevels);
    cv::calcOpticalFlowPyrLK(pyramid, pyramid_, now, back, found_back, cv::noArray(), patch_, kLevels);
    for (std::size_t i = first; i < end; ++i) {
      const std::size_t k = i - first;
      const bool returned = cv::norm(back[k] - before[k]) <= options_.klt.forward_backward_px;
      features_[i].position = now[k];
      features_[i].alive = found[k] && found_back[k] && returned && inside(now[k]);
    }
  });
  std::erase_if(features_, [](const Feature& feature) { return !feature.alive; });
}

void KltTracker::Refill(const cv::Mat& events) {
  std::vector<Eigen::Vector2d> taken;
  for (const auto& feature : features_) taken.emplace_back(feature.position.x, feature.position.y);
  const int missing = options_.features - static_cast<int>(features_.size());
  for (const auto& corner :
       DetectCorners(events, taken, missing, 0.0, options_, pool_, [](const auto&) { return true; })) {
    features_.push_back(
        {next_id_++, cv::Point2f(static_cast<float>(corner.x()), static_cast<float>(corner.y())), true});
  }
}

events::Tracks KltTracker::Observations() const {
  events::Tracks observations;
  for (const auto& feature : features_) {
    observations.push_back({feature.id, last_, feature.position.x, feature.position.y});
  }
  return observations;
}

}  // namespace evo::tracking
