#pragma once

#include <Eigen/Core>
#include <vector>

#include "evo/events/event_history.hpp"
#include "tracking/patch/density_map.hpp"

namespace evo::tracking {

/// Where and how a template lies in the sensor around a reference instant: the template's point u appears at
/// x = offset + flow * dt + y + (rate * y + (bend . y) y) * dt with y = linear * u / (1 + perspective . u), relative to
/// the centre for which the events were gathered. Offset, flow and linear are what an alignment finds.
struct PatchMotion {
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< px
  Eigen::Vector2d flow = Eigen::Vector2d::Zero();    ///< px/s
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Eigen::Vector2d perspective = Eigen::Vector2d::Zero();  ///< 1/px
  Eigen::Matrix2d rate = Eigen::Matrix2d::Zero();         ///< 1/s
  Eigen::Vector2d bend = Eigen::Vector2d::Zero();         ///< 1/(px s)
};

/// Where the events lie in the template.
struct TemplatePoints {
  std::vector<float> u, v;  ///< px

  void Update(const events::LocalEvents& events, const PatchMotion& motion);
};

/// Adds the events to `map`, where they lie in the template.
void Accumulate(const events::LocalEvents& events, const PatchMotion& motion, DensityMap* map);

struct AlignmentOptions {
  int iterations = 20;
  double patch_radius_px = 8.0;
  double half_window_s = 0.01;
  double flow_prior = 20.0;    ///< weight of the initial flow, in events
  double affine_prior = 10.0;  ///< weight of the initial linear part, in events
  /// Of the field, see AssociationField: what an aligned window feels, no reason to move.
  PullMoments own_moments = PullMoments::Zero();
};

struct AlignmentQuality {
  double inlier_share = 0.0;  ///< mean probability that an event belongs to the template
  double residual_px = 0.0;   ///< root mean square pull left on the events after the fit
};

/// Expectation maximisation of a patch's motion against its template (Zhu et al., EM 2, a soft iterative closest
/// point): E step: look the expected partner of every event up in `field`; M step: the correction
/// u + b + g dt + M u that best takes the events to their partners, by weighted least squares, in closed form.
/// Only the offset and the flow move if `with_linear` is false.
AlignmentQuality AlignToTemplate(const events::LocalEvents& events, const AssociationField& field, int planes,
                                 const AlignmentOptions& options, bool with_linear, PatchMotion* motion);

}  // namespace evo::tracking
