#include "tracking/baseline/klt_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "tracking/detection/corner_detector.hpp"

namespace evo::tracking {

namespace {

constexpr int kPyramidLevels = 3;         // below the full resolution: motions of up to 8 half patches
constexpr double kSmoothingPx = 1.0;      // standard deviation; a single event is no gradient
constexpr double kSaturation = 6.0;       // events of a white pixel
constexpr double kMinBorderPx = 6.0;      // a patch that sticks out farther is tracked badly
constexpr std::size_t kJobFeatures = 16;  // enough to pay for a job

/// Converts counts of events to the 8-bit image of KLT. The square root makes the noise of a count independent of the
/// count.
cv::Mat ToGray(const cv::Mat& events) {
  cv::Mat smooth, gray;
  cv::sqrt(events, smooth);
  cv::GaussianBlur(smooth, smooth, cv::Size(0, 0), kSmoothingPx);
  smooth.convertTo(gray, CV_8U, 255.0 / std::sqrt(kSaturation));
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
  // KLT has larger patches than the feature tracker, which would overlap too much or stick out too far.
  options_.corner_min_spacing_px = options_.corner_spacing_px;
  options_.border_px = std::max(options_.border_px, kMinBorderPx);
}

cv::Mat KltTracker::EventImage(const events::EventHistory& history, TimeNs t) const {
  cv::Mat image = cv::Mat::zeros(history.height(), history.width(), CV_32F);
  const TimeNs begin = history.NewestWindowBegin(t - before(), t, static_cast<std::size_t>(options_.klt.events));
  history.ForEachBetween(std::max(begin, t - before()), t,
                         [&](int x, int y, TimeNs, std::int8_t) { image.at<float>(y, x) += 1.0f; });
  return image;
}

void KltTracker::Track(const events::EventHistory& history, TimeNs t) {
  events_ = EventImage(history, t);
  std::vector<cv::Mat> pyramid;
  cv::buildOpticalFlowPyramid(ToGray(events_), pyramid, patch_, kPyramidLevels);
  if (!features_.empty()) Follow(pyramid);
  pyramid_ = std::move(pyramid);
  last_ = t;
}

void KltTracker::UpdateFeatures(const events::EventHistory& /*history*/) {
  is_key_frame_ = refill_.IsDue(features_.size());
  if (is_key_frame_) Refill();
}

void KltTracker::Follow(const std::vector<cv::Mat>& pyramid) {
  const double border = options_.border_px;
  const auto is_inside = [&](const cv::Point2f& p) {
    return p.x >= border && p.y >= border && p.x <= width_ - 1 - border && p.y <= height_ - 1 - border;
  };
  pool_->ForEach((features_.size() + kJobFeatures - 1) / kJobFeatures, [&](std::size_t job) {
    const std::size_t first = job * kJobFeatures;
    const std::size_t end = std::min(first + kJobFeatures, features_.size());
    std::vector<cv::Point2f> before, after, returned;
    std::vector<unsigned char> found, found_again;
    for (std::size_t i = first; i < end; ++i) before.push_back(features_[i].position);
    cv::calcOpticalFlowPyrLK(pyramid_, pyramid, before, after, found, cv::noArray(), patch_, kPyramidLevels);
    cv::calcOpticalFlowPyrLK(pyramid, pyramid_, after, returned, found_again, cv::noArray(), patch_, kPyramidLevels);
    for (std::size_t i = first; i < end; ++i) {
      const std::size_t k = i - first;
      const bool is_consistent = cv::norm(returned[k] - before[k]) <= options_.klt.forward_backward_px;
      features_[i].position = after[k];
      features_[i].alive = found[k] && found_again[k] && is_consistent && is_inside(after[k]);
    }
  });
  std::erase_if(features_, [](const Feature& feature) { return !feature.alive; });
}

void KltTracker::Refill() {
  std::vector<Eigen::Vector2d> taken;
  for (const auto& feature : features_) taken.emplace_back(feature.position.x, feature.position.y);
  const int missing = options_.features - static_cast<int>(features_.size());
  for (const auto& corner :
       DetectCorners(events_, taken, missing, 0.0, options_, pool_, [](const auto&) { return true; })) {
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
