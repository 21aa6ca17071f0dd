#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/tracking/tracker_options.hpp"

namespace evo::tracking {

/// Harris corners of a motion-compensated event image, spread over the image: at most `count`, each with `min_events`
/// in its patch and with `is_wanted`. They keep the spacing of the options to each other and to the points `taken`, or
/// the minimum spacing where that leaves too few.
std::vector<Eigen::Vector2d> DetectCorners(const cv::Mat& image, const std::vector<Eigen::Vector2d>& taken, int count,
                                           double min_events, const TrackerOptions& options, ThreadPool* pool,
                                           const std::function<bool(const Eigen::Vector2d&)>& is_wanted);

}  // namespace evo::tracking
