#pragma once

#include <Eigen/Core>
#include <vector>

#include "evo/events/event_history.hpp"
#include "tracking/patch/association_table.hpp"
#include "tracking/patch/event_histogram.hpp"

namespace evo::tracking {

/// Motion of a template in the sensor around a reference instant: the template's point u appears at
///     x = offset + flow * dt + y + (linear_rate * y + (quadratic_rate . y) y) * dt
/// with y = linear * u / (1 + perspective . u), relative to the centre for which the events were gathered. An alignment
/// finds offset, flow and linear; the others are predicted (see PatchFlow).
struct PatchMotion {
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();          ///< px
  Eigen::Vector2d flow = Eigen::Vector2d::Zero();            ///< px/s
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();      ///< template to sensor
  Eigen::Vector2d perspective = Eigen::Vector2d::Zero();     ///< 1/px
  Eigen::Matrix2d linear_rate = Eigen::Matrix2d::Zero();     ///< 1/s
  Eigen::Vector2d quadratic_rate = Eigen::Vector2d::Zero();  ///< 1/(px s)
};

/// Coordinates of events in the template.
struct TemplatePoints {
  std::vector<float> u, v;  ///< px

  /// Inverts `motion`, to the first order in dt.
  void Update(const events::LocalEvents& events, const PatchMotion& motion);
};

/// Adds the events to `histogram`, in template coordinates.
void Accumulate(const events::LocalEvents& events, const PatchMotion& motion, EventHistogram* histogram);

/// Correction of template points, px: a point u moves by (1, dt / half window, u / radius, v / radius) times this.
using TemplateCorrection = Eigen::Matrix<double, 4, 2>;

/// Changes `motion` such that the template points of all events move by the correction: exactly for an affine motion,
/// approximately with perspective or rates.
void ApplyCorrection(const TemplateCorrection& correction, double half_window_s, double patch_radius_px,
                     PatchMotion* motion);

struct AlignmentOptions {
  int iterations = 20;  ///< maximum
  double patch_radius_px = 8.0;
  double half_window_s = 0.01;
  double flow_prior = 20.0;               ///< weight of the initial flow, in events
  double affine_prior = 10.0;             ///< weight of the initial linear part, in events
  SelfBias self_bias = SelfBias::Zero();  ///< of the table; an aligned window feels it too
};

struct AlignmentQuality {
  double inlier_ratio = 0.0;  ///< mean probability that an event belongs to the template
  double residual_px = 0.0;   ///< root mean square of the shift left on the events after the fit
};

/// Expectation maximisation of a patch's motion against its template (EM 2 of A. Z. Zhu et al., ICRA 2017: a soft
/// iterative closest point). E step: look up the expected partner of every event in `table`. M step: find the
/// correction u + b + g dt + M u that best moves the events to their partners, by weighted least squares, in closed
/// form. Without `with_linear` only the offset and the flow change.
AlignmentQuality AlignToTemplate(const events::LocalEvents& events, const AssociationTable& table, int planes,
                                 const AlignmentOptions& options, bool with_linear, PatchMotion* motion);

/// How much better the template explains the events than an even spread over its plane does, each with the outliers
/// added: the mean of log((D + D0) / (mean D + D0)) over the events, by the weights of their cells; nats an event. It
/// is about 0, or less, for noise.
double MeanLogLikelihoodRatio(const events::LocalEvents& events, const AssociationTable& table, int planes,
                              const PatchMotion& motion);

}  // namespace evo::tracking
