#include "tracking/patch/polarity_flips.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tracking/patch/gaussian_kernel.hpp"
#include "tracking/patch/simd8.hpp"

namespace evo::tracking {

namespace {

constexpr double kGradientSigmaPx = 1.0;  // of the density whose gradient is taken
constexpr double kTensorSigmaPx = 1.5;    // over which the structure tensor is averaged
constexpr float kNormalSigma = 0.25f;     // rad, of an edge's normal from the events of a patch
// A turn by d sweeps over an edge with a probability of at most d times the density of the normal's angle; d is about
// 2 sin(d / 2).
constexpr float kSweepGain = 0.8f / kNormalSigma;
constexpr double kMinTurnSine = 0.17;      // of a turn that may flip an edge: 10 degrees
constexpr double kMinSpeedSigmas = 4.0;    // a faster motion has a certain direction
constexpr float kMinSquaredSpeed = 1e-6f;  // px^2/s^2, guards a division

/// Smooth sign: x / sqrt(x^2 + sigma^2).
inline float SoftSign(float x, float sigma) { return x / std::sqrt(x * x + sigma * sigma); }

double SineOfTurn(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double norms = a.norm() * b.norm();
  if (!(norms > 0.0)) return 1.0;
  if (a.dot(b) < 0.0) return 1.0;
  return std::abs(a.x() * b.y() - a.y() * b.x()) / norms;
}

}  // namespace

TemplateVelocity TemplateVelocity::Transformed(const Eigen::Matrix2d& linear) const {
  return {linear * at_centre, linear * rate * linear.inverse()};
}

TemplateVelocity VelocityInTemplate(const PatchMotion& motion) {
  return TemplateVelocity{motion.flow, motion.linear_rate}.Transformed(motion.linear.inverse());
}

bool PolarityFlips::MayOccur(const TemplateVelocity& reference, const TemplateVelocity& present, double sigma_px_s,
                             double radius_px) {
  for (const double x : {-radius_px, radius_px}) {
    for (const double y : {-radius_px, radius_px}) {
      const Eigen::Vector2d u(x, y);
      const Eigen::Vector2d before = reference.at_centre + reference.rate * u;
      const Eigen::Vector2d now = present.at_centre + present.rate * u;
      if (now.norm() < kMinSpeedSigmas * sigma_px_s || SineOfTurn(before, now) > kMinTurnSine) return true;
    }
  }
  return false;
}

void PolarityFlips::FindEdges(const EventHistogram& histogram) {
  side_ = histogram.side();
  // A margin of zeros all around, so that a row never runs into the next one.
  thread_local std::vector<float> plane, rows, density, xx, xy, yy;
  const std::vector<float> gradient_kernel = MakeGaussianKernel(kGradientSigmaPx, histogram.radius());
  const std::vector<float> tensor_kernel = MakeGaussianKernel(kTensorSigmaPx, histogram.radius());
  const int margin = static_cast<int>(std::max(gradient_kernel.size(), tensor_kernel.size()));
  const int width = (side_ + margin + kLanes - 1) / kLanes * kLanes;
  const auto cells = static_cast<std::size_t>((side_ + 2 * margin) * width);
  for (auto* buffer : {&plane, &rows, &density, &xx, &xy, &yy}) buffer->assign(cells, 0.0f);
  for (int r = 0; r < side_; ++r) {
    for (int c = 0; c < side_; ++c) {
      float sum = 0.0f;
      for (int p = 0; p < histogram.planes(); ++p) sum += histogram.plane(p)[r * side_ + c];
      plane[static_cast<std::size_t>((margin + r) * width + c)] = sum;
    }
  }
  const std::ptrdiff_t first = margin * width;
  const auto smooth = [&](const std::vector<float>& kernel, std::vector<float>* cells_of_plane,
                          std::vector<float>* out) {
    ConvolveCells(kernel, cells_of_plane->data() + first, 1, side_ * width, rows.data() + first);
    ConvolveCells(kernel, rows.data() + first, width, side_ * width, out->data() + first);
  };
  smooth(gradient_kernel, &plane, &density);
  for (int r = 0; r < side_; ++r) {
    for (int c = 0; c < side_; ++c) {
      const std::ptrdiff_t i = first + r * width + c;
      const float dx = c > 0 && c + 1 < side_ ? density[i + 1] - density[i - 1] : 0.0f;
      const float dy = r > 0 && r + 1 < side_ ? density[i + width] - density[i - width] : 0.0f;
      xx[i] = dx * dx;
      xy[i] = dx * dy;
      yy[i] = dy * dy;
    }
  }
  for (auto* moment : {&xx, &xy, &yy}) smooth(tensor_kernel, moment, moment);
  const auto count = static_cast<std::size_t>(side_ * side_);
  normal_x_.resize(count);
  normal_y_.resize(count);
  for (int r = 0; r < side_; ++r) {
    for (int c = 0; c < side_; ++c) {
      const std::ptrdiff_t i = first + r * width + c;
      // The eigenvector of the larger eigenvalue, by the half-angle formulas.
      const float difference = xx[i] - yy[i];
      const float length = std::sqrt(difference * difference + 4.0f * xy[i] * xy[i]);
      const float cosine = length > 0.0f ? difference / length : 1.0f;
      const auto cell = static_cast<std::size_t>(r * side_ + c);
      normal_x_[cell] = std::sqrt(0.5f * std::max(0.0f, 1.0f + cosine));
      normal_y_[cell] = std::copysign(std::sqrt(0.5f * std::max(0.0f, 1.0f - cosine)), xy[i]);
    }
  }
}

void PolarityFlips::Update(const TemplateVelocity& reference, const TemplateVelocity& present, double sigma_px_s) {
  probability_.resize(normal_x_.size());
  const int radius = side_ / 2;
  const Eigen::Matrix2f before_rate = reference.rate.cast<float>();
  const Eigen::Matrix2f now_rate = present.rate.cast<float>();
  const Eigen::Vector2f before_centre = reference.at_centre.cast<float>();
  const Eigen::Vector2f now_centre = present.at_centre.cast<float>();
  const auto sigma = static_cast<float>(sigma_px_s);
  for (int r = 0; r < side_; ++r) {
    for (int c = 0; c < side_; ++c) {
      const auto cell = static_cast<std::size_t>(r * side_ + c);
      const auto x = static_cast<float>(c - radius);
      const auto y = static_cast<float>(r - radius);
      const float before_x = before_centre.x() + before_rate(0, 0) * x + before_rate(0, 1) * y;
      const float before_y = before_centre.y() + before_rate(1, 0) * x + before_rate(1, 1) * y;
      const float now_x = now_centre.x() + now_rate(0, 0) * x + now_rate(0, 1) * y;
      const float now_y = now_centre.y() + now_rate(1, 0) * x + now_rate(1, 1) * y;
      const float squared_before = std::max(before_x * before_x + before_y * before_y, kMinSquaredSpeed);
      const float squared_now = std::max(now_x * now_x + now_y * now_y, kMinSquaredSpeed);
      const float across_before = normal_x_[cell] * before_x + normal_y_[cell] * before_y;
      const float across_now = normal_x_[cell] * now_x + normal_y_[cell] * now_y;
      const float cosine = (before_x * now_x + before_y * now_y) / std::sqrt(squared_before * squared_now);
      const float same = SoftSign(across_before, kNormalSigma * std::sqrt(squared_before)) *
                         SoftSign(across_now, kNormalSigma * std::sqrt(squared_now));
      const float most = kSweepGain * std::sqrt(0.5f * std::max(0.0f, 1.0f - cosine));
      const float least = 1.0f - kSweepGain * std::sqrt(0.5f * std::max(0.0f, 1.0f + cosine));
      const float flip = std::max(std::min(0.5f * (1.0f - same), most), least);
      // The error of the velocity may flip it, too.
      const float certain = sigma > 0.0f ? SoftSign(std::abs(across_now), sigma) : 1.0f;
      probability_[cell] = 0.5f + certain * (flip - 0.5f);
    }
  }
}

void PolarityFlips::Apply(EventHistogram* histogram) const { histogram->ExchangePlanes(probability_); }

}  // namespace evo::tracking
