// The tracker's hot loops, on crosses that move as a whole: about 10 events/s a pixel, as on a driving car.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "tracking/detection/corner_detector.hpp"
#include "tracking/detection/flow_estimation.hpp"
#include "tracking/detection/flow_field.hpp"
#include "tracking/detection/motion_compensated_image.hpp"
#include "tracking/patch/em_alignment.hpp"
#include "tracking/patch/em_flow.hpp"
#include "tracking/synthetic_events.hpp"

namespace evo::tracking {
namespace {

constexpr TimeNs kStamp = 100'000'000;
constexpr TimeNs kHalfWindow = 20'000'000;
constexpr double kPatchRadius = 8.0;

const Eigen::Vector2d kFlow(90.0, 40.0);

const testing::CrossScene& Scene() {
  static const testing::CrossScene scene(60, 11);
  return scene;
}

const events::EventColumns& SceneEvents() {
  static const events::EventColumns events =
      Scene().Events([](double t) { return Eigen::Vector2d(kFlow * (t - ToSeconds(kStamp))); }, 0.2, 500.0);
  return events;
}

events::EventHistory MakeHistory() {
  events::EventHistory history(Scene().width, Scene().height);
  history.Append(SceneEvents());
  return history;
}

/// A cross with others all around it.
const Eigen::Vector2d& Centre() {
  const Eigen::Vector2d middle(0.5 * Scene().width, 0.5 * Scene().height);
  return *std::ranges::min_element(Scene().centres, {}, [&](const auto& centre) { return (centre - middle).norm(); });
}

events::LocalEvents GatherPatch(double radius) {
  events::LocalEvents events;
  MakeHistory().Gather({kStamp, Centre().x(), Centre().y(), kFlow.x(), kFlow.y(), radius, kHalfWindow}, &events);
  events.Subsample(static_cast<std::size_t>(TrackerOptions().max_events));
  return events;
}

EventHistogram MakeTemplate(const events::LocalEvents& events, int radius) {
  EventHistogram histogram(radius, 2);
  const Eigen::Vector2f v = kFlow.cast<float>();
  for (std::size_t i = 0; i < events.size(); ++i) {
    histogram.Vote(events.x[i] - v.x() * events.dt[i], events.y[i] - v.y() * events.dt[i],
                   histogram.PlaneOf(events.polarity[i]), 1.0f);
  }
  return histogram;
}

void CountEvents(benchmark::State& state, std::size_t events) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(events));
}

void Append(benchmark::State& state) {
  events::EventHistory history(Scene().width, Scene().height);
  for (auto _ : state) {
    history.Append(SceneEvents());
    history.DropBefore(SceneEvents().t.back() + 1);
  }
  CountEvents(state, SceneEvents().size());
}
BENCHMARK(Append);

void Gather(benchmark::State& state) {
  const events::EventHistory history = MakeHistory();
  events::LocalEvents events;
  for (auto _ : state) {
    history.Gather({kStamp, Centre().x(), Centre().y(), kFlow.x(), kFlow.y(), kPatchRadius, kHalfWindow}, &events);
    benchmark::DoNotOptimize(events.x.data());
  }
  CountEvents(state, events.size());
}
BENCHMARK(Gather);

/// Arguments: radius of the histogram in cells, sigma in tenths of a cell.
void BuildTable(benchmark::State& state) {
  const auto radius = static_cast<int>(state.range(0));
  const EventHistogram histogram = MakeTemplate(GatherPatch(radius), radius);
  AssociationTable table;
  for (auto _ : state) {
    table.Build(histogram, 0.1 * static_cast<double>(state.range(1)), 0.2);
    benchmark::DoNotOptimize(table.Interpolate(0.0f, 0.0f, 0));
  }
}
BENCHMARK(BuildTable)->ArgNames({"radius", "sigma_tenths"})->Args({12, 10})->Args({12, 25})->Args({17, 10});

void ComputeSelfBias(benchmark::State& state) {
  const EventHistogram histogram = MakeTemplate(GatherPatch(kPatchRadius), 12);
  AssociationTable table;
  table.Build(histogram, 1.0, 0.2);
  for (auto _ : state) {
    benchmark::DoNotOptimize(table.ComputeSelfBias(histogram, 1.1 * Eigen::Matrix2d::Identity(), kPatchRadius));
  }
}
BENCHMARK(ComputeSelfBias);

void Align(benchmark::State& state) {
  const events::LocalEvents events = GatherPatch(kPatchRadius);
  const EventHistogram histogram = MakeTemplate(events, 12);
  AssociationTable table;
  table.Build(histogram, 1.0, 0.2);
  AlignmentOptions options;
  options.half_window_s = ToSeconds(kHalfWindow);
  options.self_bias = table.ComputeSelfBias(histogram, Eigen::Matrix2d::Identity(), kPatchRadius);
  for (auto _ : state) {
    PatchMotion motion{{0.8, -0.5}, kFlow + Eigen::Vector2d(10.0, 5.0), Eigen::Matrix2d::Identity()};
    AlignToTemplate(events, table, 2, options, true, &motion);
    benchmark::DoNotOptimize(motion);
  }
  CountEvents(state, events.size());
}
BENCHMARK(Align);

/// Argument: size of the cells in px.
void RefineFlow(benchmark::State& state) {
  const events::LocalEvents events = GatherPatch(15.0);
  FlowEstimator estimator(17, 2, {static_cast<double>(state.range(0)), 1.5, 0.2});
  for (auto _ : state) {
    Eigen::Vector2d flow = 0.7 * kFlow;
    estimator.Refine(events, ToSeconds(kHalfWindow), &flow);
    benchmark::DoNotOptimize(flow);
  }
  CountEvents(state, events.size());
}
BENCHMARK(RefineFlow)->ArgName("cell_px")->Arg(1)->Arg(2);

void EstimateFlowFromNothing(benchmark::State& state) {
  const events::EventHistory history = MakeHistory();
  const TrackerOptions options;
  for (auto _ : state) {
    Eigen::Vector2d flow = Eigen::Vector2d::Zero();
    EstimateFlow(history, kStamp, Centre(), options, &flow);
    benchmark::DoNotOptimize(flow);
  }
}
BENCHMARK(EstimateFlowFromNothing);

void EventImage(benchmark::State& state) {
  const events::EventHistory history = MakeHistory();
  const TrackerOptions options;
  FlowField field(Scene().width, Scene().height, options);
  ThreadPool pool(1);
  field.Update(
      history, kStamp, {}, [](const Eigen::Vector2d&) { return std::nullopt; }, &pool);
  for (auto _ : state) {
    const cv::Mat image =
        MotionCompensatedImage(history, kStamp, field, options.corner_window_motion_px, options, &pool);
    benchmark::DoNotOptimize(image.data);
  }
  CountEvents(state, SceneEvents().size());
}
BENCHMARK(EventImage);

void DetectCornersInImage(benchmark::State& state) {
  const events::EventHistory history = MakeHistory();
  const TrackerOptions options;
  FlowField field(Scene().width, Scene().height, options);
  ThreadPool pool(1);
  field.Update(
      history, kStamp, {}, [](const Eigen::Vector2d&) { return std::nullopt; }, &pool);
  const cv::Mat image = MotionCompensatedImage(history, kStamp, field, options.corner_window_motion_px, options, &pool);
  const auto wanted = [](const Eigen::Vector2d&) { return true; };
  for (auto _ : state) benchmark::DoNotOptimize(DetectCorners(image, {}, 50, 0.0, options, &pool, wanted));
}
BENCHMARK(DetectCornersInImage);

}  // namespace
}  // namespace evo::tracking
