#include "tracking/patch/em_affine.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "tracking/patch/event_lanes.hpp"

namespace evo::tracking {

namespace {

constexpr double kSmallestStep = 0.02;  // px, of the offset; a few times that at the patch's and the window's edge
constexpr double kSlowest = 0.7;        // a step over the one before it
// The template has an edge of some width itself, so a plain M step closes only part of the gap.
constexpr double kOverRelaxation = 1.5;
constexpr float kFarthest = 0.2f;  // depth of the patch's centre over that of its farthest points

using Design = Eigen::Matrix4d;                  // over (1, dt / half window, u / radius, v / radius)
using Correction = Eigen::Matrix<double, 4, 2>;  // the same rows, for x and y

struct Moments {
  Design normal;
  Correction pull;
  double weight = 0.0;
  double squares = 0.0;
  double all = 0.0;  // weight if no event were stray
};

/// A PatchMotion that events are taken back by.
struct InverseMotion {
  explicit InverseMotion(const PatchMotion& motion)
      : inverse(motion.linear.inverse().cast<float>()),
        rate(motion.rate.cast<float>()),
        offset(motion.offset.cast<float>()),
        flow(motion.flow.cast<float>()),
        perspective(motion.perspective.cast<float>()),
        bend(motion.bend.cast<float>()) {}

  /// Of one event or of many.
  template <typename Float>
  EVO_INLINE void ToTemplate(const Float& event_x, const Float& event_y, const Float& dt, Float* u, Float* v) const {
    const Float x = event_x - offset.x() - flow.x() * dt;
    const Float y = event_y - offset.y() - flow.y() * dt;
    const Float bent = bend.x() * x + bend.y() * y;
    const Float x0 = x - dt * (rate(0, 0) * x + rate(0, 1) * y + bent * x);
    const Float y0 = y - dt * (rate(1, 0) * x + rate(1, 1) * y + bent * y);
    const Float a = inverse(0, 0) * x0 + inverse(0, 1) * y0;
    const Float b = inverse(1, 0) * x0 + inverse(1, 1) * y0;
    const Float depth = 1.0f - perspective.x() * a - perspective.y() * b;
    const Float nearer = 1.0f / (depth > kFarthest ? depth : Float{} + kFarthest);
    *u = a * nearer;
    *v = b * nearer;
  }

  Eigen::Matrix2f inverse, rate;
  Eigen::Vector2f offset, flow, perspective, bend;
};

/// Sums over the events, of pull x regressors and of weight x regressors x regressors.
struct MomentSums {
  float w, wt, wu, wv, wtt, wtu, wtv, wuu, wuv, wvv;
  float x, xt, xu, xv, y, yt, yu, yv;
  float squares, all;
};

EVO_HOT void SumMoments(const events::LocalEvents& events, const InverseMotion& motion, const AssociationField& field,
                        int planes, float per_window, float per_radius, MomentSums* sums) {
  Lanes w{}, wt{}, wu{}, wv{}, wtt{}, wtu{}, wtv{}, wuu{}, wuv{}, wvv{};
  Lanes sum_x{}, xt{}, xu{}, xv{}, sum_y{}, yt{}, yu{}, yv{}, squares{}, all{};
  const std::int32_t second = planes == 2 ? field.side() * field.side() : 0;
  const Lanes nothing = Lanes{} + 1e-30f;
  for (std::size_t begin = 0; begin < events.size(); begin += kLanes) {
    Lanes event_x, event_y, dt;
    Load(events.x, begin, kOutside, &event_x);
    Load(events.y, begin, kOutside, &event_y);
    Load(events.dt, begin, 0.0f, &dt);
    std::int32_t planes_of[kLanes];
    FindPlanes(events.polarity, begin, second, planes_of);
    Lanes u, v;
    motion.ToTemplate(event_x, event_y, dt, &u, &v);
    LaneColumns pull;
    PullsAt(field, u, v, planes_of, &pull);
    const auto& [inlier, pull_x, pull_y, centre] = pull;
    const Lanes t = dt * per_window;
    u *= per_radius;
    v *= per_radius;
    const Lanes pt = inlier * t;
    const Lanes pu = inlier * u;
    const Lanes pv = inlier * v;
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
    sum_x += pull_x;
    xt += pull_x * t;
    xu += pull_x * u;
    xv += pull_x * v;
    sum_y += pull_y;
    yt += pull_y * t;
    yu += pull_y * u;
    yv += pull_y * v;
    squares += (pull_x * pull_x + pull_y * pull_y) / (inlier > nothing ? inlier : nothing);
    all += centre;
  }
  *sums = {Sum(w),     Sum(wt), Sum(wu), Sum(wv), Sum(wtt),   Sum(wtu), Sum(wtv), Sum(wuu), Sum(wuv),     Sum(wvv),
           Sum(sum_x), Sum(xt), Sum(xu), Sum(xv), Sum(sum_y), Sum(yt),  Sum(yu),  Sum(yv),  Sum(squares), Sum(all)};
}

Moments Expect(const events::LocalEvents& events, const AssociationField& field, int planes,
               const AlignmentOptions& options, const PatchMotion& motion) {
  MomentSums s;
  SumMoments(events, InverseMotion(motion), field, planes, static_cast<float>(1.0 / options.half_window_s),
             static_cast<float>(1.0 / options.patch_radius_px), &s);
  Moments moments;
  moments.normal << s.w, s.wt, s.wu, s.wv, s.wt, s.wtt, s.wtu, s.wtv, s.wu, s.wtu, s.wuu, s.wuv, s.wv, s.wtv, s.wuv,
      s.wvv;
  moments.pull << s.x, s.y, s.xt, s.yt, s.xu, s.yu, s.xv, s.yv;
  moments.weight = s.w;
  moments.squares = s.squares;
  moments.all = s.all;
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

void Accumulate(const events::LocalEvents& events, const PatchMotion& motion, DensityMap* map) {
  thread_local TemplatePoints points;
  points.Update(events, motion);
  map->Vote(points.u, points.v, events.polarity);
}

AlignmentQuality AlignToTemplate(const events::LocalEvents& events, const AssociationField& field, int planes,
                                 const AlignmentOptions& options, bool with_linear, PatchMotion* motion) {
  const Eigen::Vector4d prior(0.0, options.flow_prior, options.affine_prior, options.affine_prior);
  Correction moved = Correction::Zero();  // so far, which the priors pull back
  double last_length = 0.0;               // of a step
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
    const double length = step.norm();
    const bool settled =
        (motion->linear * step.row(0).transpose()).norm() < kSmallestStep && length < 3.0 * kSmallestStep;
    // Steps shrink geometrically, so the last goes as far as all that would follow it.
    if (settled && iteration > 0) step /= 1.0 - std::min(length / last_length, kSlowest);
    last_length = length;
    moved += step;

    // Events should appear at u + b + g dt + M u, so the template lies where the inverse of that puts it.
    Eigen::Matrix2d m;
    m << step(2, 0), step(3, 0), step(2, 1), step(3, 1);
    motion->linear = motion->linear * (Eigen::Matrix2d::Identity() + m / options.patch_radius_px).inverse();
    motion->offset -= motion->linear * step.row(0).transpose();
    motion->flow -= motion->linear * step.row(1).transpose() / options.half_window_s;
    if (settled) break;
  }
  return quality;
}

}  // namespace evo::tracking
