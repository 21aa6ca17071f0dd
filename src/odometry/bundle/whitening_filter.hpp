#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace evo::odometry {

/// One step of a whitening filter: the Kalman filter of a track's drift, whose normalised innovations are white
/// (T. Kailath: An Innovations Approach to Least-Squares Estimation, IEEE Trans. Automatic Control 1968).
///
/// The reprojection errors e_k of one track consist of white noise v and a drift b, which is a random walk from the
/// track's first observation on; in each image coordinate
///     e_k = m_k b_k + v_k,   b_0 = 0,   b_(k+1) = b_k + d_k / m_k,   var d = drift_variance_ratio * var v.
/// A track slides over the surface that it follows, so its drift grows with the image of that surface: m_k is the
/// surface's magnification since the first observation.
///
/// A bundle adjustment that assumes independent errors trusts long tracks too much and bends the path, because the
/// errors that a point's depth absorbs are correlated with those that remain.
struct WhiteningStep {
  double inverse_magnification;  ///< 1 / m_k
  double kalman_gain;
  double normalization;  ///< scales the innovation to its standard deviation late in an unmagnified track
};

/// Appends the steps of one track with these magnifications at its observations.
void AppendWhiteningSteps(double drift_variance_ratio, std::span<const double> magnifications,
                          std::vector<WhiteningStep>* steps);

/// The normalised innovations of one track's errors, one a step. Without drift they are the errors. An infinite error
/// is its own innovation and does not enter the later ones.
void ComputeInnovations(std::span<const WhiteningStep> steps, const std::vector<Eigen::Vector2d>& errors,
                        std::vector<Eigen::Vector2d>* innovations);

/// The filtered drift m_k b_k after each error, in the errors' unit; 0 without drift.
void EstimateDrift(std::span<const WhiteningStep> steps, const std::vector<Eigen::Vector2d>& errors,
                   std::vector<Eigen::Vector2d>* drifts);

/// L^T diag(innovation_weights) L with the matrix L that takes errors to innovations: the information matrix of one
/// coordinate of the errors, in units of an innovation's information.
void ComputeErrorInformation(std::span<const WhiteningStep> steps, const std::vector<double>& innovation_weights,
                             Eigen::MatrixXd* information);

}  // namespace evo::odometry
