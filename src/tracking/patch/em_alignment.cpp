#include "tracking/patch/em_alignment.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "tracking/patch/event_simd8.hpp"

namespace evo::tracking {

namespace {

constexpr double kConvergencePx = 0.02;       // of the offset; three times that at the patch's and the window's edge
constexpr double kMaxConvergenceRatio = 0.7;  // of a step to the one before: a geometric series needs less than 1
// The template's edges have a width of their own, so a plain M step closes only part of the gap.
constexpr double kOverRelaxation = 1.5;
constexpr float kMinDepthRatio = 0.2f;  // of the patch's centre to its farthest points: the horizon would be at 0

using Normal = Eigen::Matrix4d;  // over the rows of a TemplateCorrection

/// The E step's result: normal equations of the M step.
struct Moments {
  Normal normal;
  TemplateCorrection shift;
  double weight = 0.0;      // of the inliers
  double squares = 0.0;     // of the shifts, px^2
  double all_weight = 0.0;  // of all events
};

/// The inverse of a PatchMotion.
struct InverseMotion {
  explicit InverseMotion(const PatchMotion& motion)
      : inverse(motion.linear.inverse().cast<float>()),
        linear_rate(motion.linear_rate.cast<float>()),
        offset(motion.offset.cast<float>()),
        flow(motion.flow.cast<float>()),
        perspective(motion.perspective.cast<float>()),
        quadratic_rate(motion.quadratic_rate.cast<float>()) {}

  /// `Float`: float or F32x8.
  template <typename Float>
  EVO_INLINE void ToTemplate(const Float& event_x, const Float& event_y, const Float& dt, Float* u, Float* v) const {
    const Float x = event_x - offset.x() - flow.x() * dt;
    const Float y = event_y - offset.y() - flow.y() * dt;
    const Float scale = quadratic_rate.x() * x + quadratic_rate.y() * y;
    const Float x0 = x - dt * (linear_rate(0, 0) * x + linear_rate(0, 1) * y + scale * x);
    const Float y0 = y - dt * (linear_rate(1, 0) * x + linear_rate(1, 1) * y + scale * y);
    const Float a = inverse(0, 0) * x0 + inverse(0, 1) * y0;
    const Float b = inverse(1, 0) * x0 + inverse(1, 1) * y0;
    const Float depth = 1.0f - perspective.x() * a - perspective.y() * b;
    const Float inverse_depth = 1.0f / (depth > kMinDepthRatio ? depth : Float{} + kMinDepthRatio);
    *u = a * inverse_depth;
    *v = b * inverse_depth;
  }

  Eigen::Matrix2f inverse, linear_rate;
  Eigen::Vector2f offset, flow, perspective, quadratic_rate;
};

/// Eight events in the coordinates of the template, with their associations.
struct EventsInTemplate8 {
  F32x8 dt, u, v;
  std::int32_t plane_offsets[kLanes];
  Columns8 associations;

  EVO_INLINE void LookUp(const events::LocalEvents& events, std::size_t begin, const InverseMotion& motion,
                         const AssociationTable& table, std::int32_t negative_offset) {
    F32x8 event_x, event_y, event_dt;
    Load(events.x, begin, kOutsidePx, &event_x);
    Load(events.y, begin, kOutsidePx, &event_y);
    Load(events.dt, begin, 0.0f, &event_dt);
    dt = event_dt;
    FindPlaneOffsets(events.polarity, begin, negative_offset, plane_offsets);
    motion.ToTemplate(event_x, event_y, dt, &u, &v);
    InterpolateAssociations(table, u, v, plane_offsets, &associations);
  }
};

/// Sums over the events of shift x regressors and of weight x regressors x regressors.
struct MomentSums {
  float w, wt, wu, wv, wtt, wtu, wtv, wuu, wuv, wvv;
  float x, xt, xu, xv, y, yt, yu, yv;
  float squares, all_weight;
};

EVO_HOT void SumMoments(const events::LocalEvents& events, const InverseMotion& motion, const AssociationTable& table,
                        int planes, float per_window, float per_radius, MomentSums* sums) {
  F32x8 w{}, wt{}, wu{}, wv{}, wtt{}, wtu{}, wtv{}, wuu{}, wuv{}, wvv{};
  F32x8 sum_x{}, xt{}, xu{}, xv{}, sum_y{}, yt{}, yu{}, yv{}, squares{}, all_weight{};
  const std::int32_t negative_offset = planes == 2 ? table.side() * table.side() : 0;
  const F32x8 epsilon = F32x8{} + 1e-30f;
  for (std::size_t begin = 0; begin < events.size(); begin += kLanes) {
    EventsInTemplate8 at;
    at.LookUp(events, begin, motion, table, negative_offset);
    const auto& [inlier, shift_x, shift_y, weight] = at.associations;
    const F32x8 t = at.dt * per_window;
    const F32x8 u = at.u * per_radius;
    const F32x8 v = at.v * per_radius;
    const F32x8 pt = inlier * t;
    const F32x8 pu = inlier * u;
    const F32x8 pv = inlier * v;
    w += inlier;
    wt += pt;
    wu += pu;
    wv += pv;
    wtt += pt * t;
    wtu += pt * u;
    wtv += pt * v;
    wuu += pu * u;
    wuv += pu * v;
    wvv += pv * v;
    sum_x += shift_x;
    xt += shift_x * t;
    xu += shift_x * u;
    xv += shift_x * v;
    sum_y += shift_y;
    yt += shift_y * t;
    yu += shift_y * u;
    yv += shift_y * v;
    squares += (shift_x * shift_x + shift_y * shift_y) / (inlier > epsilon ? inlier : epsilon);
    all_weight += weight;
  }
  *sums = {Sum(w),     Sum(wt),  Sum(wu),  Sum(wv),    Sum(wtt),     Sum(wtu),       Sum(wtv),
           Sum(wuu),   Sum(wuv), Sum(wvv), Sum(sum_x), Sum(xt),      Sum(xu),        Sum(xv),
           Sum(sum_y), Sum(yt),  Sum(yu),  Sum(yv),    Sum(squares), Sum(all_weight)};
}

EVO_HOT void SumLogLikelihoods(const events::LocalEvents& events, const InverseMotion& motion,
                               const AssociationTable& table, int planes, float* sum, float* sum_of_weights) {
  F32x8 total{}, total_weight{};
  const std::int32_t negative_offset = planes == 2 ? table.side() * table.side() : 0;
  const float even[2] = {table.log_even_density(0), table.log_even_density(planes - 1)};
  const F32x8 epsilon = F32x8{} + 1e-30f;
  const F32x8 min_outlier = F32x8{} + 1e-6f;
  for (std::size_t begin = 0; begin < events.size(); begin += kLanes) {
    EventsInTemplate8 at;
    at.LookUp(events, begin, motion, table, negative_offset);
    const F32x8& weight = at.associations.d;
    // The outlier probability is D0 / (D + D0).
    const F32x8 outlier = 1.0f - at.associations.a / (weight > epsilon ? weight : epsilon);
    F32x8 log_outlier, log_even;
    Log(outlier > min_outlier ? outlier : min_outlier, &log_outlier);
    for (int i = 0; i < kLanes; ++i) log_even[i] = even[at.plane_offsets[i] != 0];
    total -= weight * (log_outlier + log_even);
    total_weight += weight;
  }
  *sum = Sum(total);
  *sum_of_weights = Sum(total_weight);
}

Moments Expect(const events::LocalEvents& events, const AssociationTable& table, int planes,
               const AlignmentOptions& options, const PatchMotion& motion) {
  MomentSums s;
  SumMoments(events, InverseMotion(motion), table, planes, static_cast<float>(1.0 / options.half_window_s),
             static_cast<float>(1.0 / options.patch_radius_px), &s);
  Moments moments;
  moments.normal << s.w, s.wt, s.wu, s.wv, s.wt, s.wtt, s.wtu, s.wtv, s.wu, s.wtu, s.wuu, s.wuv, s.wv, s.wtv, s.wuv,
      s.wvv;
  moments.shift << s.x, s.y, s.xt, s.yt, s.xu, s.yu, s.xv, s.yv;
  moments.weight = s.w;
  moments.squares = s.squares;
  moments.all_weight = s.all_weight;
  return moments;
}

}  // namespace

void TemplatePoints::Update(const events::LocalEvents& events, const PatchMotion& motion) {
  const InverseMotion inverse(motion);
  u.resize(events.size());
  v.resize(events.size());
  // The compiler vectorises this loop.
  for (std::size_t i = 0; i < events.size(); ++i) {
    inverse.ToTemplate(events.x[i], events.y[i], events.dt[i], &u[i], &v[i]);
  }
}

void Accumulate(const events::LocalEvents& events, const PatchMotion& motion, EventHistogram* histogram) {
  thread_local TemplatePoints points;
  points.Update(events, motion);
  histogram->Vote(points.u, points.v, events.polarity);
}

void ApplyCorrection(const TemplateCorrection& correction, double half_window_s, double patch_radius_px,
                     PatchMotion* motion) {
  Eigen::Matrix2d m;
  m << correction(2, 0), correction(3, 0), correction(2, 1), correction(3, 1);
  motion->linear = motion->linear * (Eigen::Matrix2d::Identity() + m / patch_radius_px).inverse();
  motion->offset -= motion->linear * correction.row(0).transpose();
  motion->flow -= motion->linear * correction.row(1).transpose() / half_window_s;
}

AlignmentQuality AlignToTemplate(const events::LocalEvents& events, const AssociationTable& table, int planes,
                                 const AlignmentOptions& options, bool with_linear, PatchMotion* motion) {
  const Eigen::Vector4d prior(0.0, options.flow_prior, options.affine_prior, options.affine_prior);
  TemplateCorrection total = TemplateCorrection::Zero();  // of all steps so far; the priors pull it back
  double last_length = 0.0;                               // of a step
  AlignmentQuality quality;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    Moments moments = Expect(events, table, planes, options, *motion);
    if (!(moments.weight > 1.0)) return {};
    quality.inlier_ratio = moments.weight / moments.all_weight;
    quality.residual_px = std::sqrt(moments.squares / moments.weight);
    const SelfBias& bias = options.self_bias;
    moments.shift.row(0) -= moments.weight * bias.col(0).transpose();
    moments.shift.row(2) -= moments.weight / options.patch_radius_px * bias.col(1).transpose();
    moments.shift.row(3) -= moments.weight / options.patch_radius_px * bias.col(2).transpose();

    Normal normal = moments.normal;
    normal.diagonal() += prior;
    const TemplateCorrection target = moments.shift - prior.asDiagonal() * total;
    TemplateCorrection step = TemplateCorrection::Zero();
    // Both systems have a fixed size, which is faster.
    if (with_linear) {
      step = normal.ldlt().solve(target);
    } else {
      step.topRows<2>() = normal.topLeftCorner<2, 2>().ldlt().solve(target.topRows<2>());
    }
    if (!step.allFinite()) return {};
    step *= kOverRelaxation;
    const double length = step.norm();
    const bool converged =
        (motion->linear * step.row(0).transpose()).norm() < kConvergencePx && length < 3.0 * kConvergencePx;
    // Steps shrink geometrically, so the last one goes as far as the rest of the series.
    if (converged && iteration > 0) step /= 1.0 - std::min(length / last_length, kMaxConvergenceRatio);
    last_length = length;
    total += step;

    ApplyCorrection(step, options.half_window_s, options.patch_radius_px, motion);
    if (converged) break;
  }
  return quality;
}

double MeanLogLikelihoodRatio(const events::LocalEvents& events, const AssociationTable& table, int planes,
                              const PatchMotion& motion) {
  float sum = 0.0f;
  float weight = 0.0f;
  SumLogLikelihoods(events, InverseMotion(motion), table, planes, &sum, &weight);
  return weight > 0.0f ? static_cast<double>(sum / weight) : 0.0;
}

}  // namespace evo::tracking
