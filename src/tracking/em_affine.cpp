#include "evo/tracking/em_affine.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <vector>

namespace evo {

namespace {

constexpr double kSmallestStep = 0.01;  // px, of the offset; a few times that at the patch's and the window's edge
// The template has an edge of some width itself, so a plain M step closes only part of the gap.
constexpr double kOverRelaxation = 1.5;
constexpr float kFarthest = 0.2f;  // depth of the patch's centre over that of its farthest points

using Design = Eigen::Matrix4d;                  // over (1, dt / half window, u / radius, v / radius)
using Correction = Eigen::Matrix<double, 4, 2>;  // the same rows, for x and y

struct Moments {
  Design normal = Design::Zero();
  Correction pull = Correction::Zero();
  double weight = 0.0;
  double squares = 0.0;
  double all = 0.0;  // weight if no event were stray
};

Moments Expect(const LocalEvents& events, const AssociationField& field, int planes, const AlignmentOptions& options,
               const PatchMotion& motion) {
  thread_local TemplatePoints points;
  points.Update(events, motion);
  const auto per_window = static_cast<float>(1.0 / options.half_window_s);
  const auto per_radius = static_cast<float>(1.0 / options.patch_radius_px);
  using Row = Eigen::Array4f;
  // Added up, since four scalars stored and loaded as one row stall the processor.
  const Row one(1.0f, 0.0f, 0.0f, 0.0f), in_window(0.0f, per_window, 0.0f, 0.0f);
  const Row in_width(0.0f, 0.0f, per_radius, 0.0f), in_height(0.0f, 0.0f, 0.0f, per_radius);
  Row n0 = Row::Zero(), n1 = Row::Zero(), n2 = Row::Zero(), n3 = Row::Zero(), x = Row::Zero(), y = Row::Zero();
  float squares = 0.0f, all = 0.0f;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const float u = points.u[i];
    const float v = points.v[i];
    const AssociationField::Pull pull = field.At(u, v, planes == 2 && events.polarity[i] < 0 ? 1 : 0);
    all += pull[3];
    if (!(pull[0] > 0.0f)) continue;
    const Row regressors = one + events.dt[i] * in_window + u * in_width + v * in_height;
    const Row weighted = pull[0] * regressors;
    n0 += weighted;
    n1 += regressors[1] * weighted;
    n2 += regressors[2] * weighted;
    n3 += regressors[3] * weighted;
    x += pull[1] * regressors;
    y += pull[2] * regressors;
    squares += (pull[1] * pull[1] + pull[2] * pull[2]) / pull[0];
  }
  Moments moments;
  moments.normal << n0.matrix().cast<double>(), n1.matrix().cast<double>(), n2.matrix().cast<double>(),
      n3.matrix().cast<double>();
  moments.pull << x.matrix().cast<double>(), y.matrix().cast<double>();
  moments.weight = n0[0];
  moments.squares = squares;
  moments.all = all;
  return moments;
}

}  // namespace

void TemplatePoints::Update(const LocalEvents& events, const PatchMotion& motion) {
  const Eigen::Matrix2f inverse = motion.linear.inverse().cast<float>();
  const Eigen::Vector2f offset = motion.offset.cast<float>();
  const Eigen::Vector2f flow = motion.flow.cast<float>();
  const Eigen::Vector2f perspective = motion.perspective.cast<float>();
  const Eigen::Matrix2f rate = motion.rate.cast<float>();
  const Eigen::Vector2f bend = motion.bend.cast<float>();
  u.resize(events.size());
  v.resize(events.size());
  float* const out_u = u.data();
  float* const out_v = v.data();
  // The compiler vectorises this loop.
  for (std::size_t i = 0; i < events.size(); ++i) {
    const float dt = events.dt[i];
    const float x = events.x[i] - offset.x() - flow.x() * dt;
    const float y = events.y[i] - offset.y() - flow.y() * dt;
    const float bent = bend.x() * x + bend.y() * y;
    const float x0 = x - dt * (rate(0, 0) * x + rate(0, 1) * y + bent * x);
    const float y0 = y - dt * (rate(1, 0) * x + rate(1, 1) * y + bent * y);
    const float a = inverse(0, 0) * x0 + inverse(0, 1) * y0;
    const float b = inverse(1, 0) * x0 + inverse(1, 1) * y0;
    const float depth = 1.0f - perspective.x() * a - perspective.y() * b;
    const float nearer = 1.0f / (depth > kFarthest ? depth : kFarthest);
    out_u[i] = a * nearer;
    out_v[i] = b * nearer;
  }
}

void Accumulate(const LocalEvents& events, const PatchMotion& motion, DensityMap* map) {
  thread_local TemplatePoints points;
  points.Update(events, motion);
  for (std::size_t i = 0; i < events.size(); ++i) {
    map->Vote(points.u[i], points.v[i], map->PlaneOf(events.polarity[i]), 1.0f);
  }
}

AlignmentQuality AlignToTemplate(const LocalEvents& events, const AssociationField& field, int planes,
                                 const AlignmentOptions& options, bool with_linear, PatchMotion* motion) {
  const Eigen::Vector4d prior(0.0, options.flow_prior, options.affine_prior, options.affine_prior);
  Correction moved = Correction::Zero();  // so far, which the priors pull back
  AlignmentQuality quality;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    Moments moments = Expect(events, field, planes, options, *motion);
    if (!(moments.weight > 1.0)) return {};
    quality.inlier_share = moments.weight / moments.all;
    quality.residual_px = std::sqrt(moments.squares / moments.weight);
    const auto& own = options.own_moments;
    moments.pull.row(0) -= moments.weight * own.col(0).transpose();
    moments.pull.row(2) -= moments.weight / options.patch_radius_px * own.col(1).transpose();
    moments.pull.row(3) -= moments.weight / options.patch_radius_px * own.col(2).transpose();

    Design normal = moments.normal;
    normal.diagonal() += prior;
    const Correction target = moments.pull - prior.asDiagonal() * moved;
    Correction step = Correction::Zero();
    // Of fixed size, which is faster.
    if (with_linear) {
      step = normal.ldlt().solve(target);
    } else {
      step.topRows<2>() = normal.topLeftCorner<2, 2>().ldlt().solve(target.topRows<2>());
    }
    if (!step.allFinite()) return {};
    step *= kOverRelaxation;
    moved += step;

    // Events should appear at u + b + g dt + M u, so the template lies where the inverse of that puts it.
    Eigen::Matrix2d m;
    m << step(2, 0), step(3, 0), step(2, 1), step(3, 1);
    motion->linear = motion->linear * (Eigen::Matrix2d::Identity() + m / options.patch_radius_px).inverse();
    motion->offset -= motion->linear * step.row(0).transpose();
    motion->flow -= motion->linear * step.row(1).transpose() / options.half_window_s;
    quality.last_step_px = (motion->linear * step.row(0).transpose()).norm();
    if (quality.last_step_px < kSmallestStep && step.norm() < 3.0 * kSmallestStep) break;
  }
  return quality;
}

}  // namespace evo
