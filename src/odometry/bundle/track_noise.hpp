#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace evo::odometry {

/// What the errors of one track are like, sighting by sighting: white noise v and a drift b that walks at random from
/// where the track begins,
///     e_k = m_k b_k + v_k,   b_0 = 0,   b_(k+1) = b_k + d_k / m_k,   var d = drift * var v   in each coordinate.
/// A track slides over the surface that it follows, so what it has slid grows with the image: m_k is the magnification
/// of the surface since the first sighting.
///
/// A bundle adjustment that takes such errors to be independent trusts long tracks too much and bends the path: what a
/// point's depth has absorbed of its errors is correlated with what is left of them. A Kalman filter of b turns them
/// into innovations, which are independent and of one size; this is one step of it.
struct InnovationStep {
  double shrink;  ///< 1 / m_k
  double gain;    ///< of the filter
  double scale;   ///< brings every innovation to the size that it has late in a track without magnification
};

/// Appends the steps of one track, given the magnification at each of its sightings.
void AppendInnovationSteps(double drift, std::span<const double> magnifications, std::vector<InnovationStep>* steps);

/// Both of the length of `steps`. With a drift of 0 the innovations are the errors. An infinite error counts as none
/// for those after it, and is its own innovation.
void Innovate(std::span<const InnovationStep> steps, const std::vector<Eigen::Vector2d>& errors,
              std::vector<Eigen::Vector2d>* innovations);

/// The part of every error that is thought to be drift, m_k b_k, given the errors so far. With a drift of 0 it is 0.
void EstimateDrift(std::span<const InnovationStep> steps, const std::vector<Eigen::Vector2d>& errors,
                   std::vector<Eigen::Vector2d>* drifts);

/// L^T diag(weights) L, where L turns errors into innovations: the inverse covariance of one coordinate of the errors,
/// in units of an innovation's, if the innovations have these weights.
void InformationOfErrors(std::span<const InnovationStep> steps, const std::vector<double>& weights,
                         Eigen::MatrixXd* information);

}  // namespace evo::odometry
