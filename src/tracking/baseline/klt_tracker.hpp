#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "tracking/tracker.hpp"

namespace evo::tracking {

/// The baseline: what one would build from ready parts instead of tracking events. Images of the newest events, without
/// motion compensation, and on them Harris corners and pyramidal KLT with a forward-backward check (OpenCV's; J.-Y.
/// Bouguet: Pyramidal Implementation of the Lucas Kanade Feature Tracker).
///
/// A position is that in the image of the events *before* the stamp, so the feature was there about half the image's
/// window ago: at 1.3 M events/s and 30,000 events 12 ms, more where less happens. That lag is part of the baseline and
/// is not taken out, since it varies with the event rate and over the image.
class KltTracker : public Tracker {
 public:
  KltTracker(int width, int height, const TrackerOptions& options, ThreadPool* pool);

  void Process(const events::EventHistory& history, TimeNs t, const std::function<void()>& read_ahead) override;
  TimeNs before() const override { return FromSeconds(options_.klt.max_window_s); }
  TimeNs after() const override { return 0; }
  events::Tracks Observations() const override;
  std::vector<std::int64_t> Withdrawn() const override { return {}; }
  std::vector<ObservedWindow> Windows() const override { return std::vector<ObservedWindow>(features_.size()); }
  bool detected() const override { return detected_; }

 private:
  struct Feature {
    std::int64_t id;
    cv::Point2f position;
    bool alive;
  };

  cv::Mat EventImage(const events::EventHistory& history, TimeNs t) const;
  /// Takes the features from the image before to the one of `pyramid`; those that do not find back are lost.
  void Follow(const std::vector<cv::Mat>& pyramid);
  void Refill(const cv::Mat& events);

  TrackerOptions options_;
  int width_;
  int height_;
  cv::Size patch_;
  ThreadPool* pool_;
  RefillPolicy refill_;
  std::vector<cv::Mat> pyramid_;  // of the frame before
  std::vector<Feature> features_;
  std::int64_t next_id_ = 0;
  TimeNs last_ = 0;
  bool detected_ = false;
};

}  // namespace evo::tracking
