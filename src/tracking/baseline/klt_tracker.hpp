#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "tracking/detection/refill_policy.hpp"
#include "tracking/tracker.hpp"

namespace evo::tracking {

/// The baseline, built from standard parts: Harris corners on images of the newest events, without motion compensation,
/// and OpenCV's pyramidal KLT with a forward-backward check (J.-Y. Bouguet: Pyramidal Implementation of the Lucas
/// Kanade Feature Tracker; Z. Kalal et al.: Forward-Backward Error, ICPR 2010).
///
/// A position refers to the image of the events *before* the stamp, so it lags by about half the image's window: 12 ms
/// at 1.3 M events/s and 30,000 events, more at lower rates. The baseline does not compensate this lag, since it varies
/// with the event rate and over the image.
class KltTracker : public Tracker {
 public:
  KltTracker(int width, int height, const TrackerOptions& options, ThreadPool* pool);

  void Track(const events::EventHistory& history, TimeNs t) override;
  void EstimateMotion() override {}
  void UpdateFeatures(const events::EventHistory& history) override;
  TimeNs before() const override { return FromSeconds(options_.klt.max_window_s); }
  TimeNs after() const override { return 0; }
  events::Tracks Observations() const override;
  std::vector<std::int64_t> Rejected() const override { return {}; }
  std::vector<ObservedWindow> Windows() const override { return std::vector<ObservedWindow>(features_.size()); }
  bool is_key_frame() const override { return is_key_frame_; }

 private:
  struct Feature {
    std::int64_t id;
    cv::Point2f position;
    bool alive;
  };

  cv::Mat EventImage(const events::EventHistory& history, TimeNs t) const;
  /// Moves the features from the last image to that of `pyramid`, and drops those whose return track ends elsewhere.
  void Follow(const std::vector<cv::Mat>& pyramid);
  void Refill();

  TrackerOptions options_;
  int width_;
  int height_;
  cv::Size patch_;
  ThreadPool* pool_;
  RefillPolicy refill_;
  cv::Mat events_;                // image of the frame
  std::vector<cv::Mat> pyramid_;  // of the last frame
  std::vector<Feature> features_;
  std::int64_t next_id_ = 0;
  TimeNs last_ = 0;
  bool is_key_frame_ = false;
};

}  // namespace evo::tracking
