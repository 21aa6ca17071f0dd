#pragma once

#include <Eigen/Core>
#include <vector>

#include "tracking/patch/em_alignment.hpp"
#include "tracking/patch/event_histogram.hpp"

namespace evo::tracking {

/// Velocity of the template's points in template coordinates: a point u moves with at_centre + rate * u.
struct TemplateVelocity {
  Eigen::Vector2d at_centre = Eigen::Vector2d::Zero();  ///< px/s
  Eigen::Matrix2d rate = Eigen::Matrix2d::Zero();       ///< 1/s

  /// The velocity where coordinates are `linear` * u.
  TemplateVelocity Transformed(const Eigen::Matrix2d& linear) const;
};

TemplateVelocity VelocityInTemplate(const PatchMotion& motion);

/// An edge with brightness gradient g that moves with v makes events of the sign of -g . v (G. Gallego et al.:
/// Event-based Vision: A Survey, PAMI 2022, equation 3), so its polarity flips where g . v changes its sign: where the
/// edge's direction lies between those of the two velocities. This is the probability of it, for each cell of a
/// histogram, from the cell's edge direction.
class PolarityFlips {
 public:
  struct Turn {
    const TemplateVelocity& reference;
    const TemplateVelocity& present;
    double sigma_px_s;  ///< standard deviation of the present velocity
  };

  /// Finds the edges in the events of `histogram`, of both polarities together, and which of them the turn flips.
  void Update(const EventHistogram& histogram, const Turn& turn);
  /// Whether any polarity may flip. None does while the motion goes on in its direction.
  bool any() const { return any_; }
  /// Exchanges the two planes of a histogram in proportion to the probabilities.
  void Apply(EventHistogram* histogram) const;

 private:
  void FindEdges(const EventHistogram& histogram);
  void FindProbabilities(const Turn& turn);

  bool any_ = false;
  int side_ = 0;
  std::vector<float> normal_x_, normal_y_;  // of the edges; of any sign
  std::vector<float> probability_;
};

}  // namespace evo::tracking
