#pragma once

#include <Eigen/Core>
#include <optional>

#include "evo/core/time.hpp"
#include "evo/events/event_history.hpp"
#include "evo/tracking/tracker_options.hpp"
#include "tracking/patch/association_table.hpp"
#include "tracking/patch/em_alignment.hpp"
#include "tracking/patch/event_histogram.hpp"
#include "tracking/patch/polarity_flips.hpp"

namespace evo::tracking {

/// Maps the template's point u to linear * u / (1 + perspective . u), px from the feature's position.
struct PatchShape {
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Eigen::Vector2d perspective = Eigen::Vector2d::Zero();  ///< 1/px
};

/// The events of a window, and the motion of the pattern that they show.
struct AlignedWindow {
  const events::LocalEvents& events;
  const PatchMotion& motion;
  TimeNs half;                 ///< of the window
  const PolarityFlips& flips;  ///< against the template
};

/// The pattern of a feature: the events of its windows so far, in template coordinates.
class FeatureTemplate {
 public:
  /// Learns from the first window, in which the pattern moved with `velocity`.
  FeatureTemplate(EventHistogram first_window, const TemplateVelocity& velocity);

  /// Of total 1, however many events the windows held, with the polarities of the first window's velocity.
  const EventHistogram& histogram() const { return histogram_; }
  /// Finds the polarities that another velocity flips.
  void FindFlips(const TemplateVelocity& velocity, double sigma_px_s, PolarityFlips* flips) const;
  /// Scale of the template's coordinates relative to the first window.
  double scale() const { return scale_; }

  /// The bias of the histogram as it is now, if known.
  const std::optional<SelfBias>& self_bias() const { return self_bias_; }
  void set_self_bias(const SelfBias& self_bias) { self_bias_ = self_bias; }

  /// Time passes without a new window.
  void AddTime(double step_s) { unlearnt_s_ += step_s; }
  /// Learns from an aligned window unless it mostly repeats the last one: as a running mean at first, then as one that
  /// forgets, because a patch changes while it approaches. Resamples the template where the shape has changed much, and
  /// then resets the shape.
  void Learn(const AlignedWindow& window, const TrackerOptions& options, PatchShape* shape);

 private:
  void Blend(const AlignedWindow& window, double gain);
  void ResampleIfNeeded(int patch_radius_px, PatchShape* shape);

  EventHistogram histogram_;
  TemplateVelocity velocity_;  // of the first window, in the coordinates of the histogram
  std::optional<SelfBias> self_bias_;
  double scale_ = 1.0;
  int windows_ = 1;          // learnt
  double unlearnt_s_ = 0.0;  // since the last of them
};

}  // namespace evo::tracking
