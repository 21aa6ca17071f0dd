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
constexpr double kMinTurnSine = 0.87;      // of a turn that flips many edges: 60 degrees
constexpr double kMinSpeedSigmas = 3.0;    // a faster motion has a certain direction
constexpr float kMinTensor = 1e-30f;       // guards a division
constexpr float kMinSquaredSpeed = 1e-6f;  // px^2/s^2, guards a division

/// Velocities of a row of cells: (x, y) + column * (x_step, y_step), px/s.
struct RowVelocity {
  float x, y, x_step, y_step;
};

EVO_HOT void FindFlipProbabilities(const RowVelocity& before, const RowVelocity& now, float sigma,
                                   const float* normal_x, const float* normal_y, int cells, float* probability) {
  const float squared_sigma = sigma * sigma + kMinSquaredSpeed;
  constexpr float kSquaredNormalSigma = kNormalSigma * kNormalSigma;
  // The compiler vectorises this loop.
  for (int c = 0; c < cells; ++c) {
    const auto column = static_cast<float>(c);
    const float before_x = before.x + column * before.x_step;
    const float before_y = before.y + column * before.y_step;
    const float now_x = now.x + column * now.x_step;
    const float now_y = now.y + column * now.y_step;
    const float squared_before = before_x * before_x + before_y * before_y + kMinSquaredSpeed;
    const float squared_now = now_x * now_x + now_y * now_y + kMinSquaredSpeed;
    const float across_before = normal_x[c] * before_x + normal_y[c] * before_y;
    const float across_now = normal_x[c] * now_x + normal_y[c] * now_y;
    const float squared_across = across_now * across_now;
    const float cosine = (before_x * now_x + before_y * now_y) / std::sqrt(squared_before * squared_now);
    const float same = across_before * across_now /
                       std::sqrt((across_before * across_before + kSquaredNormalSigma * squared_before) *
                                 (squared_across + kSquaredNormalSigma * squared_now));
    const float most = kSweepGain * std::sqrt(std::max(0.0f, 0.5f - 0.5f * cosine));
    const float least = 1.0f - kSweepGain * std::sqrt(std::max(0.0f, 0.5f + 0.5f * cosine));
    const float flip = std::max(std::min(0.5f - 0.5f * same, most), least);
    // The error of the velocity may flip it, too.
    const float certain = std::sqrt(squared_across / (squared_across + squared_sigma));
    probability[c] = 0.5f + certain * (flip - 0.5f);
  }
}

double SineOfTurn(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double norms = a.norm() * b.norm();
  if (!(norms > 0.0)) return 1.0;
  if (a.dot(b) < 0.0) return 1.0;
  return std::abs(a.x() * b.y() - a.y() * b.x()) / norms;
}

bool MayFlip(const PolarityFlips::Turn& turn, double radius_px) {
  for (const double x : {-radius_px, radius_px}) {
    for (const double y : {-radius_px, radius_px}) {
      const Eigen::Vector2d u(x, y);
      const Eigen::Vector2d before = turn.reference.at_centre + turn.reference.rate * u;
      const Eigen::Vector2d now = turn.present.at_centre + turn.present.rate * u;
      if (now.norm() < kMinSpeedSigmas * turn.sigma_px_s || SineOfTurn(before, now) > kMinTurnSine) return true;
    }
  }
  return false;
}

/// The normals of edges by the structure tensor (xx, xy, yy): the eigenvector of its larger eigenvalue, by the
/// half-angle formulas.
EVO_HOT void FindNormals(const float* xx, const float* xy, const float* yy, int cells, float* normal_x,
                         float* normal_y) {
  for (int c = 0; c < cells; ++c) {
    const float difference = xx[c] - yy[c];
    const float cosine = difference / std::sqrt(difference * difference + 4.0f * xy[c] * xy[c] + kMinTensor);
    const float sine = std::sqrt(std::max(0.0f, 0.5f - 0.5f * cosine));
    normal_x[c] = std::sqrt(std::max(0.0f, 0.5f + 0.5f * cosine));
    normal_y[c] = xy[c] < 0.0f ? -sine : sine;
  }
}

}  // namespace

TemplateVelocity TemplateVelocity::Transformed(const Eigen::Matrix2d& linear) const {
  return {linear * at_centre, linear * rate * linear.inverse()};
}

TemplateVelocity VelocityInTemplate(const PatchMotion& motion) {
  return TemplateVelocity{motion.flow, motion.linear_rate}.Transformed(motion.linear.inverse());
}

void PolarityFlips::Update(const EventHistogram& histogram, const Turn& turn) {
  any_ = histogram.planes() == 2 && MayFlip(turn, histogram.radius());
  if (!any_) return;
  FindEdges(histogram);
  FindProbabilities(turn);
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
    const std::ptrdiff_t i = first + r * width;
    FindNormals(xx.data() + i, xy.data() + i, yy.data() + i, side_, normal_x_.data() + r * side_,
                normal_y_.data() + r * side_);
  }
}

void PolarityFlips::FindProbabilities(const Turn& turn) {
  probability_.resize(normal_x_.size());
  const int radius = side_ / 2;
  const auto row_of = [&](const TemplateVelocity& velocity, int v) -> RowVelocity {
    const Eigen::Vector2f first = (velocity.at_centre + velocity.rate * Eigen::Vector2d(-radius, v)).cast<float>();
    return {first.x(), first.y(), static_cast<float>(velocity.rate(0, 0)), static_cast<float>(velocity.rate(1, 0))};
  };
  for (int r = 0; r < side_; ++r) {
    const int first = r * side_;
    FindFlipProbabilities(row_of(turn.reference, r - radius), row_of(turn.present, r - radius),
                          static_cast<float>(turn.sigma_px_s), normal_x_.data() + first, normal_y_.data() + first,
                          side_, probability_.data() + first);
  }
}

void PolarityFlips::Apply(EventHistogram* histogram) const {
  if (any_) histogram->ExchangePlanes(probability_);
}

}  // namespace evo::tracking
