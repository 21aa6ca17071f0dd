#include "tracking/patch/polarity_flips.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>

#include "tracking/patch/histogram_smoother.hpp"
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

/// Memory that each thread keeps for histograms of one size.
struct EdgeWorkspace {
  explicit EdgeWorkspace(int side)
      : density(side, kGradientSigmaPx), tensor(3, HistogramSmoother(side, kTensorSigmaPx)) {
    events.resize(static_cast<std::size_t>(side * side));
    products.fill(events);
  }

  static EdgeWorkspace& ForThread(int side) {
    thread_local std::map<int, EdgeWorkspace> workspaces;
    return workspaces.try_emplace(side, side).first->second;
  }

  HistogramSmoother density;
  std::vector<HistogramSmoother> tensor;       // of each of the products
  std::vector<float> events;                   // of both polarities
  std::array<std::vector<float>, 3> products;  // xx, xy, yy of the density's gradient
};

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
  EdgeWorkspace& w = EdgeWorkspace::ForThread(side_);
  const int cells = side_ * side_;
  std::copy_n(histogram.plane(0), cells, w.events.data());
  for (int i = 0; i < cells; ++i) w.events[static_cast<std::size_t>(i)] += histogram.plane(1)[i];
  w.density.Smooth(w.events.data());
  const int width = w.density.width();
  for (int r = 0; r < side_; ++r) {
    for (int c = 0; c < side_; ++c) {
      const float* const at = w.density.smooth() + r * width + c;
      const float dx = c > 0 && c + 1 < side_ ? at[1] - at[-1] : 0.0f;
      const float dy = r > 0 && r + 1 < side_ ? at[width] - at[-width] : 0.0f;
      const auto cell = static_cast<std::size_t>(r * side_ + c);
      w.products[0][cell] = dx * dx;
      w.products[1][cell] = dx * dy;
      w.products[2][cell] = dy * dy;
    }
  }
  for (std::size_t k = 0; k < w.products.size(); ++k) w.tensor[k].Smooth(w.products[k].data());
  normal_x_.resize(static_cast<std::size_t>(cells));
  normal_y_.resize(normal_x_.size());
  for (int r = 0; r < side_; ++r) {
    const auto row = [&](std::size_t k) { return w.tensor[k].smooth() + r * w.tensor[k].width(); };
    FindNormals(row(0), row(1), row(2), side_, normal_x_.data() + r * side_, normal_y_.data() + r * side_);
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
