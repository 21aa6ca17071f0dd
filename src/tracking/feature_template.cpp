#include "tracking/feature_template.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace evo::tracking {

namespace {

// A window that repeats the last one adds only the error of its own alignment: at least this part must be new.
constexpr double kMinNewRatio = 0.4;
// The template is resampled when the patch has grown or shrunk by this factor,
constexpr double kMaxScaleChange = 1.25;
// or when the depth varies by this ratio from its centre to its edge: cells of 1 px would alias or blur the pattern.
constexpr double kMaxPerspective = 0.25;

}  // namespace

FeatureTemplate::FeatureTemplate(EventHistogram first_window, const TemplateVelocity& velocity)
    : histogram_(std::move(first_window)), velocity_(velocity) {
  histogram_.Scale(static_cast<float>(1.0 / histogram_.Total()));
}

void FeatureTemplate::FindFlips(const TemplateVelocity& velocity, double sigma_px_s, PolarityFlips* flips) const {
  flips->Update(histogram_, {velocity_, velocity, sigma_px_s});
}

void FeatureTemplate::Learn(const AlignedWindow& window, const TrackerOptions& options, PatchShape* shape) {
  const double new_ratio = std::min(1.0, unlearnt_s_ / (2.0 * ToSeconds(window.half)));
  if (new_ratio < kMinNewRatio) return;
  unlearnt_s_ = 0.0;
  ++windows_;
  Blend(window, std::max(1.0 - std::pow(1.0 - options.template_gain, new_ratio), 1.0 / windows_));
  ResampleIfNeeded(options.patch_radius_px, shape);
  self_bias_.reset();
}

void FeatureTemplate::Blend(const AlignedWindow& window, double gain) {
  thread_local std::optional<EventHistogram> histogram;
  if (!histogram || histogram->side() != histogram_.side() || histogram->planes() != histogram_.planes()) {
    histogram.emplace(histogram_.radius(), histogram_.planes());
  }
  histogram->Clear();
  Accumulate(window.events, window.motion, &*histogram);
  window.flips.Apply(&*histogram);
  // Windows have equal weights, however many events they hold.
  const double factor = gain / std::max(1.0, histogram->Total());
  histogram_.Blend(static_cast<float>(1.0 - gain), *histogram, static_cast<float>(factor));
}

void FeatureTemplate::ResampleIfNeeded(int patch_radius_px, PatchShape* shape) {
  const double growth = std::sqrt(std::abs(shape->linear.determinant()));
  const double perspective = shape->perspective.norm() * patch_radius_px;
  if (growth > kMaxScaleChange || growth < 1.0 / kMaxScaleChange || perspective > kMaxPerspective) {
    histogram_ = histogram_.Warped(shape->linear, shape->perspective);
    velocity_ = velocity_.Transformed(shape->linear);
    scale_ *= growth;
    *shape = PatchShape();
  }
}

}  // namespace evo::tracking
