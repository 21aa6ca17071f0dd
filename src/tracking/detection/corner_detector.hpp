#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "evo/core/parallel.hpp"
#include "evo/events/event_history.hpp"
#include "evo/tracking/tracker_options.hpp"
#include "tracking/detection/flow_field.hpp"

namespace evo::tracking {

/// Image of the events around `t`, each moved along the flow to where its edge was at `t` (the paper's corrected event
/// frame, figure 2c): CV_32F, events per pixel, sharp where the raw image is smeared. The window is as long as the flow
/// needs to move `motion_px`, pixel by pixel.
cv::Mat CorrectedEventImage(const events::EventHistory& history, TimeNs t, const FlowField& flow, double motion_px,
                            const TrackerOptions& options, ThreadPool* pool);

/// Harris corners of a corrected event image, strongest first, spread over the image: at most `count`, none nearer than
/// the options' spacing to another or to a point of `taken`, or where those are too few the closest one, each with
/// `min_events` in its patch and wanted.
std::vector<Eigen::Vector2d> DetectCorners(const cv::Mat& image, const std::vector<Eigen::Vector2d>& taken, int count,
                                           double min_events, const TrackerOptions& options, ThreadPool* pool,
                                           const std::function<bool(const Eigen::Vector2d&)>& is_wanted);

}  // namespace evo::tracking
